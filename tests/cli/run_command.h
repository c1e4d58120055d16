// Runs the real program as a subprocess, in a fresh folder of the test's own.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace blackleaf::test {

struct Result {
  int code = -1;  // exit status; 128 + signal for a process that was killed
  std::string out, err;

  nlohmann::json json() const { return nlohmann::json::parse(out); }
};

class CliTest : public testing::Test {
 protected:
  CliTest();
  ~CliTest() override;

  /// Runs `blackleaf arguments...` in folder() with `input` on standard input.
  Result run(const std::vector<std::string>& arguments, const std::string& input = {}) const;
  /// The same for a command that must succeed silently on standard error.
  Result done(const std::vector<std::string>& arguments, const std::string& input = {}) const;
  /// A command that must be refused: exit status 2, one line on standard error that holds `part`, nothing on standard
  /// output, and a folder with the same files as before.
  void refused(const std::vector<std::string>& arguments, const std::string& part, const std::string& input = {}) const;

  const std::filesystem::path& folder() const { return folder_; }
  void write(const std::string& name, const std::string& content) const;
  std::string read(const std::string& name) const;
  /// Names of everything in the folder, sorted, hidden files too.
  std::vector<std::string> files() const;

  /// An octree of the given depth whose black voxels are [min, max), as a file.
  void make_box(const std::string& name, int depth, const std::array<int, 3>& min, const std::array<int, 3>& max) const;
  /// A NRRD file of bytes, x fastest, as text; `more` are header lines, e.g. geometry.
  void make_nrrd(const std::string& name, const std::array<int, 3>& size, const std::vector<int>& values,
                 const std::string& more = {}) const;
  /// An ASCII STL file of the box [min, max]; without its last triangle if `open`.
  void make_stl(const std::string& name, const std::array<double, 3>& min, const std::array<double, 3>& max,
                bool open = false) const;

 private:
  std::filesystem::path folder_;
};

/// Number of line ends in a text.
std::size_t lines(const std::string& text);

}  // namespace blackleaf::test
