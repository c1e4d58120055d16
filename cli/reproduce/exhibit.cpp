#include "exhibit.h"

#include <fmt/format.h>

#include <cassert>

#include "plot/markup.h"

namespace blackleaf::cli {
namespace {

constexpr const char* kStyle = R"(
body { font: 16px/1.5 Georgia, serif; max-width: 70em; margin: 2em auto; padding: 0 1em; color: #111; }
h1, h2 { line-height: 1.2; } section { margin-top: 3em; }
table { border-collapse: collapse; font: 14px/1.4 sans-serif; margin: 1em 0; display: block; overflow-x: auto; }
caption { text-align: left; font-style: italic; padding-bottom: .5em; }
th, td { border: 1px solid #bbb; padding: .2em .6em; text-align: right; } th { background: #eee; }
td:last-child { text-align: left; } svg { max-width: 100%; height: auto; } nav a { margin-right: 1.5em; }
figure { margin: 1em 0; } figcaption svg { margin: 0 .5em .5em 0; }
)";

// A value as CSV has it (RFC 4180).
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::string paragraph(const std::string& html) { return "<p>" + html + "</p>\n"; }

std::string Table::html() const {
  std::string text = "<table><caption>" + detail::markup_text(caption) + "</caption>\n<tr>";
  for (const std::string& column : columns) text += "<th>" + detail::markup_text(column) + "</th>";
  text += "</tr>\n";
  for (const auto& row : rows) {
    assert(row.size() == columns.size());
    text += "<tr>";
    for (const std::string& entry : row) text += "<td>" + detail::markup_text(entry) + "</td>";
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

std::string Table::csv() const {
  std::string text;
  const auto line = [&](const std::vector<std::string>& fields) {
    for (std::size_t i = 0; i < fields.size(); ++i) text += (i > 0 ? "," : "") + csv_field(fields[i]);
    text += "\n";
  };
  line(columns);
  for (const auto& row : rows) line(row);
  return text;
}

std::string html_page(const std::vector<Exhibit>& exhibits) {
  std::string text = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width\">\n"
      "<title>Blackleaf: the papers' tables and figures</title>\n<style>{}</style></head>\n<body>\n"
      "<h1>The papers' tables and figures, computed afresh</h1>\n",
      kStyle);
  text += paragraph("Made by <code>blackleaf reproduce</code> " BLACKLEAF_VERSION
                    ". A dash stands where the print cannot be read or says nothing.");
  text += "<nav>";
  for (const Exhibit& exhibit : exhibits)
    text += fmt::format("<a href=\"#{}\">{}</a>", exhibit.id,
                        detail::markup_text(exhibit.title.substr(0, exhibit.title.find(':'))));
  text += "</nav>\n";
  for (const Exhibit& exhibit : exhibits)
    text += fmt::format("<section id=\"{}\"><h2>{}</h2>\n{}</section>\n", exhibit.id,
                        detail::markup_text(exhibit.title), exhibit.body);
  return text + "</body></html>\n";
}

}  // namespace blackleaf::cli
