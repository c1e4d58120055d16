#include "cli/run_command.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "blackleaf/implicit.h"
#include "blackleaf/octree_file.h"

namespace blackleaf::test {
namespace fs = std::filesystem;

CliTest::CliTest() {
  std::string name = (fs::temp_directory_path() / "blackleaf-cli-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
  folder_ = fs::path(name) / "work";
  fs::create_directory(folder_);
}

CliTest::~CliTest() {
  std::error_code ignored;
  fs::remove_all(folder_.parent_path(), ignored);
}

std::string CliTest::read(const std::string& name) const {
  std::ifstream file(folder_ / name, std::ios::binary);
  EXPECT_TRUE(file.good()) << name;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void CliTest::write(const std::string& name, const std::string& content) const {
  std::ofstream(folder_ / name, std::ios::binary) << content;
}

std::vector<std::string> CliTest::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder_)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

Result CliTest::run(const std::vector<std::string>& arguments, const std::string& input) const {
  // Files beside the working folder: no pipe that could fill up, nothing for files() to see.
  const fs::path beside = folder_.parent_path();
  std::ofstream(beside / "in", std::ios::binary) << input;
  std::vector<std::string> words = {BLACKLEAF_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const std::string in = beside / "in", out = beside / "out", err = beside / "err";

  const pid_t child = fork();
  if (child == 0) {
    const int in_file = open(in.c_str(), O_RDONLY);
    const int out_file = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int err_file = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (in_file < 0 || out_file < 0 || err_file < 0 || chdir(folder_.c_str()) != 0) _exit(125);
    dup2(in_file, 0);
    dup2(out_file, 1);
    dup2(err_file, 2);
    execv(argv[0], argv.data());
    _exit(126);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child) throw std::runtime_error("cannot run " BLACKLEAF_PROGRAM);
  const auto content = [](const std::string& name) {
    std::ostringstream text;
    text << std::ifstream(name, std::ios::binary).rdbuf();
    return text.str();
  };
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), content(out), content(err)};
}

Result CliTest::done(const std::vector<std::string>& arguments, const std::string& input) const {
  Result result = run(arguments, input);
  EXPECT_EQ(result.code, 0) << testing::PrintToString(arguments);
  EXPECT_EQ(result.err, "") << testing::PrintToString(arguments);
  return result;
}

void CliTest::refused(const std::vector<std::string>& arguments, const std::string& part,
                      const std::string& input) const {
  SCOPED_TRACE(testing::PrintToString(arguments));
  const std::vector<std::string> before = files();
  const Result result = run(arguments, input);
  EXPECT_EQ(result.code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(lines(result.err), 1u) << result.err;
  EXPECT_TRUE(result.err.starts_with("blackleaf: ")) << result.err;
  EXPECT_NE(result.err.find(part), std::string::npos) << result.err << "does not hold: " << part;
  EXPECT_EQ(files(), before);
}

void CliTest::make_box(const std::string& name, int depth, const std::array<int, 3>& min,
                       const std::array<int, 3>& max) const {
  save(box(depth, min, max), folder_ / name);
}

void CliTest::make_nrrd(const std::string& name, const std::array<int, 3>& size, const std::vector<int>& values,
                        const std::string& more) const {
  std::ostringstream text;
  text << "NRRD0004\ntype: uchar\ndimension: 3\nsizes: " << size[0] << ' ' << size[1] << ' ' << size[2]
       << "\nencoding: raw\n"
       << more << '\n';
  for (const int value : values) text.put(static_cast<char>(value));
  write(name, text.str());
}

void CliTest::make_stl(const std::string& name, const std::array<double, 3>& min, const std::array<double, 3>& max,
                       bool open) const {
  // The corners of the two triangles of each side as octant labels, outward.
  constexpr std::array<std::array<int, 3>, 12> kTriangles = {{{0, 4, 6},
                                                              {0, 6, 2},
                                                              {1, 3, 7},
                                                              {1, 7, 5},
                                                              {0, 1, 5},
                                                              {0, 5, 4},
                                                              {2, 6, 7},
                                                              {2, 7, 3},
                                                              {0, 2, 3},
                                                              {0, 3, 1},
                                                              {4, 5, 7},
                                                              {4, 7, 6}}};
  std::ostringstream text;
  text << "solid box\n";
  for (std::size_t i = 0; i + (open ? 1 : 0) < kTriangles.size(); ++i) {
    text << "facet normal 0 0 0\nouter loop\n";
    for (const int corner : kTriangles[i]) {
      text << "vertex";
      for (std::size_t axis = 0; axis < 3; ++axis) text << ' ' << ((corner >> axis & 1) ? max : min)[axis];
      text << '\n';
    }
    text << "endloop\nendfacet\n";
  }
  text << "endsolid box\n";
  write(name, text.str());
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace blackleaf::test
