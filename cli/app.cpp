#include "app.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>

#include "blackleaf/error.h"

namespace blackleaf::cli {
namespace {

// Help texts: descriptions wrapped to a column, no list of mutual exclusions (the error message tells).
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(kColumn); }

  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text =
        option->get_type_name().empty() || option->get_type_size() == 0 ? "" : " " + option->get_type_name();
    if (option->get_expected_max() > 1) text += " ...";
    return option->get_required() && !option->get_positional() ? text + " (required)" : text;
  }

  std::string make_option_desc(const CLI::Option* option) const override {
    const std::string& words = option->get_description();
    std::string text;
    std::size_t width = 0;
    for (std::size_t at = 0; at < words.size();) {
      const std::size_t end = std::min(words.find(' ', at), words.size());
      if (width > 0 && width + 1 + (end - at) > kTextWidth) {
        text += '\n';
        width = 0;
      } else if (width > 0) {
        text += ' ';
        ++width;
      }
      text += words.substr(at, end - at);
      width += end - at;
      at = end + 1;
    }
    return text;
  }

 private:
  static constexpr std::size_t kColumn = 30, kTextWidth = 68;
};

}  // namespace

Option* Option::required() {
  option_->required();
  return this;
}

Option* Option::excludes(Option* other) {
  option_->excludes(other->option_);
  return this;
}

Option* Option::group(const std::string& heading) {
  option_->group(heading);
  return this;
}

Option* Option::type_name(const std::string& name) {
  option_->type_name(name);
  return this;
}

Option* Option::allow_extra_args(bool allowed) {
  option_->allow_extra_args(allowed);
  return this;
}

Option* Option::repeatable() {
  option_->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return this;
}

Option* Option::expected(int values) {
  option_->expected(values);
  return this;
}

struct App::Parser {
  Parser(const std::string& description, const std::string& name) : app(description, name) {}
  CLI::App app;
};

App::App(const std::string& description, const std::string& name)
    : parser_(std::make_unique<Parser>(description, name)) {
  parser_->app.formatter(std::make_shared<HelpFormatter>());
  parser_->app.set_help_flag("-h,--help", "print this help and exit");
}

App::~App() = default;

Option* App::keep(CLI::Option* option) { return &options_.emplace_back(option); }

Option* App::add_option(const std::string& name, std::string& target, const std::string& description) {
  return keep(parser_->app.add_option(name, target, description));
}

Option* App::add_option(const std::string& name, std::vector<std::string>& targets, const std::string& description) {
  return keep(parser_->app.add_option(name, targets, description));
}

Option* App::add_option_function(const std::string& name, const std::function<void(const std::string&)>& take,
                                 const std::string& description) {
  return keep(parser_->app.add_option_function<std::string>(name, take, description));
}

Option* App::add_flag(const std::string& name, bool& target, const std::string& description) {
  return keep(parser_->app.add_flag(name, target, description));
}

Option* App::get_option(const std::string& name) { return keep(parser_->app.get_option(name)); }

void App::footer(const std::string& text) { parser_->app.footer(text); }

std::string App::help() const { return parser_->app.help(); }

bool App::parse(std::vector<std::string> arguments) {
  CLI::App& app = parser_->app;
  const std::string name = app.get_name();
  // CLI11 takes the arguments last first.
  std::reverse(arguments.begin(), arguments.end());
  std::string problem;
  try {
    app.parse(std::move(arguments));
    return true;
  } catch (const CLI::CallForHelp&) {
    return false;
  } catch (const CLI::ParseError& error) {
    problem = error.what();
  }
  // CLI11 has no clear words for an option that is there twice.
  for (const CLI::Option* option : app.get_options())
    if (option->get_type_size() != 0 && option->get_expected_max() == 1 && option->count() > 1)
      throw Error(ErrorCode::bad_argument,
                  fmt::format("{} is given {}, in {}", option->get_name(),
                              option->count() == 2 ? "twice" : fmt::format("{} times", option->count()), name),
                  "give it once");
  // CLI11 complains of a missing argument before it does of an unknown option, which is more often the reason.
  const std::vector<std::string> extras = app.remaining();
  const auto option = std::find_if(extras.begin(), extras.end(),
                                   [](const std::string& extra) { return extra.size() > 1 && extra[0] == '-'; });
  if (option != extras.end())
    problem = fmt::format("unknown option {}", *option);
  else if (!extras.empty())
    problem = fmt::format("unexpected argument '{}'", extras.front());
  throw Error(ErrorCode::bad_argument, fmt::format("{}, in {}", problem, name), fmt::format("see {} --help", name));
}

}  // namespace blackleaf::cli
