// Volumes larger than the memory that the program may have; and one that takes long enough to be interrupted.
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

#include <array>
#include <csignal>
#include <cstring>
#include <fstream>

#include "blackleaf/implicit.h"
#include "blackleaf/octree_file.h"
#include "cli/run_command.h"
#include "reference/memory_limits.h"

namespace blackleaf::test {
namespace {

namespace fs = std::filesystem;

// While it lives, programs that this one starts get so much address space at most.
class AddressSpaceLimit {
 public:
  explicit AddressSpaceLimit(rlim_t bytes) {
    getrlimit(RLIMIT_AS, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    works_ = setrlimit(RLIMIT_AS, &limit) == 0;
  }
  ~AddressSpaceLimit() { setrlimit(RLIMIT_AS, &before_); }
  AddressSpaceLimit(const AddressSpaceLimit&) = delete;
  AddressSpaceLimit& operator=(const AddressSpaceLimit&) = delete;
  bool works() const { return works_; }

 private:
  rlimit before_{};
  bool works_ = false;
};

class LargeVolume : public CliTest {
 protected:
  // A raw NRRD of zeros that takes no room on the disk, but for one box of ones. False where files have no holes.
  bool make_hollow(const std::string& name, const std::array<std::int64_t, 3>& size, const Box& box) {
    const std::string header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: " + std::to_string(size[0]) + " " +
                               std::to_string(size[1]) + " " + std::to_string(size[2]) + "\nencoding: raw\n\n";
    write(name, header);
    std::error_code error;
    fs::resize_file(folder() / name, header.size() + static_cast<std::uintmax_t>(size[0] * size[1] * size[2]), error);
    if (error) return false;
    std::fstream file(folder() / name, std::ios::binary | std::ios::in | std::ios::out);
    const std::string row(static_cast<std::size_t>(box.max[0] - box.min[0]), '\1');
    for (std::int64_t z = box.min[2]; z < box.max[2]; ++z)
      for (std::int64_t y = box.min[1]; y < box.max[1]; ++y) {
        file.seekp(static_cast<std::streamoff>(header.size()) +
                   static_cast<std::streamoff>(box.min[0] + size[0] * (y + size[1] * z)));
        file << row;
      }
    return file.good();
  }
};

// Far less than the volumes have.
constexpr rlim_t kLimit = rlim_t{320} << 20;

TEST_F(LargeVolume, RawVolumeBeyondMemory) {
  const Box box{{100, 200, 1000}, {140, 230, 1040}};
  if (!kMemoryLimits) GTEST_SKIP() << "sanitizers need more address space than the limit";
  ASSERT_TRUE(make_hollow("large.nrrd", {800, 800, 1100}, box));
  const AddressSpaceLimit limit(kLimit);
  ASSERT_TRUE(limit.works());
  for (const char* threads : {"1", "2"}) {
    const Result result = run({"build", "large.nrrd", "-o", "o.octree", "--quiet", "--threads", threads});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(load(folder() / "o.octree").octree == blackleaf::box(11, box.min, box.max));
  }
}

TEST_F(LargeVolume, PackedVolumeBeyondMemory) {
  if (!kMemoryLimits) GTEST_SKIP() << "sanitizers need more address space than the limit";
  write("large.nrrd", "NRRD0004\ntype: uint16\ndimension: 3\nsizes: 400 400 1600\nencoding: gzip\nendian: little\n\n");
  const gzFile file = gzopen((folder() / "large.nrrd").c_str(), "ab1");
  ASSERT_NE(file, nullptr);
  std::vector<std::uint16_t> slice(400 * 400);
  for (int z = 0; z < 1600; ++z) {
    std::fill(slice.begin(), slice.end(), z >= 1590 ? 7 : 0);
    ASSERT_GT(gzwrite(file, slice.data(), static_cast<unsigned>(2 * slice.size())), 0);
  }
  ASSERT_EQ(gzclose(file), Z_OK);
  const AddressSpaceLimit limit(kLimit);
  const Result result = run({"build", "large.nrrd", "-o", "o.octree", "--quiet", "--label", "7"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(load(folder() / "o.octree").octree == box(11, {0, 0, 1590}, {400, 400, 1600}));
}

// On a terminal there is a bar that tells how long it will take; Ctrl-C ends the program at once and leaves nothing.
TEST_F(LargeVolume, ProgressBarAndInterrupt) {
  if (!make_hollow("huge.nrrd", {2048, 2048, 16384}, {{0, 0, 0}, {1, 1, 1}}))
    GTEST_SKIP() << "this file system has no files of 64 GiB";
  const std::vector<std::string> before = files();
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_TRUE(terminal >= 0 && grantpt(terminal) == 0 && unlockpt(terminal) == 0);
  const std::string other_end = ptsname(terminal);
  std::vector<std::string> words = {BLACKLEAF_PROGRAM, "build", "huge.nrrd", "-o", "o.octree"};
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    const int screen = open(other_end.c_str(), O_RDWR | O_NOCTTY);
    if (screen < 0 || chdir(folder().c_str()) != 0) _exit(125);
    dup2(screen, 2);
    execv(argv[0], argv.data());
    _exit(126);
  }
  ASSERT_GT(child, 0);
  std::string seen;
  bool told = false;
  for (;;) {
    pollfd waiting{terminal, POLLIN, 0};
    constexpr int kLongest = 60'000;  // milliseconds; the bar comes after one second
    if (poll(&waiting, 1, kLongest) <= 0) break;
    std::array<char, 4096> bytes;
    const ssize_t got = ::read(terminal, bytes.data(), bytes.size());
    if (got <= 0) break;  // the program has ended
    seen.append(bytes.data(), static_cast<std::size_t>(got));
    if (!told && seen.find(" left") != std::string::npos) {
      told = true;
      kill(child, SIGINT);
    }
  }
  if (!told) kill(child, SIGKILL);
  close(terminal);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(told) << seen;
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 130) << status;
  EXPECT_NE(seen.find("\rbuild    ["), std::string::npos) << seen;
  EXPECT_NE(seen.find("%  about "), std::string::npos) << seen;
  EXPECT_NE(seen.find("blackleaf: interrupted; nothing was written"), std::string::npos) << seen;
  EXPECT_EQ(files(), before);
}

}  // namespace
}  // namespace blackleaf::test
