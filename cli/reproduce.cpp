// blackleaf reproduce: the papers' tables and figures, computed afresh beside the printed ones.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <system_error>
#include <vector>

#include "blackleaf/drawing_file.h"
#include "blackleaf/error.h"
#include "commands.h"
#include "file/atomic_write.h"
#include "files.h"
#include "reproduce/exhibit.h"

namespace fs = std::filesystem;

namespace blackleaf::cli {
namespace {

struct Maker {
  const char* stage;
  Exhibit (*make)(const Work&);
};

// In the order of the page.
constexpr std::array<Maker, 14> kExhibits = {{{"figures", an84_figure_2},
                                              {"figures", an84_figure_3},
                                              {"figures", an84_figure_4},
                                              {"table 1", wa87_table_1},
                                              {"table 2", wa87_table_2},
                                              {"figures", mhf92_figure_1},
                                              {"drawings", [](const Work& work) { return va88_figure(5, work); }},
                                              {"drawings", [](const Work& work) { return va88_figure(6, work); }},
                                              {"drawings", [](const Work& work) { return va88_figure(7, work); }},
                                              {"drawings", [](const Work& work) { return va88_figure(8, work); }},
                                              {"drawings", [](const Work& work) { return va88_figure(9, work); }},
                                              {"drawings", [](const Work& work) { return va88_figure(10, work); }},
                                              {"drawings", [](const Work& work) { return va88_figure(11, work); }},
                                              {"times", va88_figure_12}}};

void make_folder(const std::string& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    throw Error(ErrorCode::io, fmt::format("cannot write into '{}': it is a file", folder), "name a folder");
  const fs::path path = fs::path(folder).lexically_normal();
  const fs::path plain = path.has_filename() ? path : path.parent_path();  // without the slash at the end
  const fs::path parent = plain.has_parent_path() ? plain.parent_path() : fs::path(".");
  if (!fs::is_directory(parent, error))
    throw Error(ErrorCode::io, fmt::format("cannot make folder '{}': there is no folder '{}'", folder, parent.string()),
                "make that first");
  if (!fs::is_directory(folder, error) && !fs::create_directory(plain, error))
    throw Error(ErrorCode::io, fmt::format("cannot make folder '{}': {}", folder, error.message()), "name another");
}

}  // namespace

int run_reproduce(Session& session) {
  std::string folder;
  session.app()
      .add_option("-o,--output", folder, "folder to write into; made if it is not there")
      ->required()
      ->type_name("FOLDER");
  session.add_json();
  session.set_example("blackleaf reproduce -o papers && xdg-open papers/index.html");
  if (!session.parse()) return kDone;
  if (folder.empty()) throw Error(ErrorCode::bad_argument, "the folder's name is empty", "give one after -o");

  std::vector<Exhibit> exhibits;
  exhibits.reserve(kExhibits.size());
  for (const Maker& maker : kExhibits)
    exhibits.push_back(session.stage(maker.stage, [&](const Work& work) { return maker.make(work); }));

  std::vector<std::string> names;
  session.write_stage([&] {
    make_folder(folder);
    const auto write = [&](const std::string& name, const auto& put) {
      put(fs::path(folder) / name);
      names.push_back(name);
      set_left_behind(counted(names.size(), "file") + " of the page were written");
    };
    for (const Exhibit& exhibit : exhibits) {
      for (const ExhibitFile& file : exhibit.files)
        write(file.name, [&](const fs::path& path) { detail::write_atomically(path, file.content); });
      for (const ExhibitDrawing& picture : exhibit.drawings)
        write(picture.name, [&](const fs::path& path) { write_drawing(picture.drawing, path, picture.page); });
    }
    write("index.html", [&](const fs::path& path) { detail::write_atomically(path, html_page(exhibits)); });
  });

  if (session.json())
    print_out(Json{{"output", folder}, {"files", names}});
  else if (!session.quiet())
    print_out(fmt::format("{}: {}; open {}\n", folder, counted(names.size(), "file"),
                          (fs::path(folder) / "index.html").string()));
  return kDone;
}

}  // namespace blackleaf::cli
