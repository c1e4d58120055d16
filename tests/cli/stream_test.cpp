// Octrees through standard input and output, and Ctrl-C.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>

#include "blackleaf/implicit.h"
#include "blackleaf/octree_file.h"
#include "cli/run_command.h"

namespace blackleaf::test {
namespace {

using Streams = CliTest;

TEST_F(Streams, OctreesGoThroughPipes) {
  make_box("b.octree", 4, {3, 4, 5}, {6, 7, 8});
  const std::string moved = done({"translate", "-", "1,1,1", "-o", "-"}, read("b.octree")).out;
  const auto facts = done({"info", "-", "--json"}, moved).json();
  EXPECT_EQ(facts["bounding_box"], nlohmann::json::parse("[[4,5,6],[7,8,9]]"));
  EXPECT_EQ(facts["file_bytes"], moved.size());
  EXPECT_EQ(facts["metadata"]["source"], "standard input");
  EXPECT_EQ(run({"verify", "-"}, moved).code, 0);
  EXPECT_EQ(run({"verify", "-"}, moved.substr(0, moved.size() - 1)).code, 1);
  refused({"info", "-"}, "standard input");
  refused({"info", "-"}, "standard input", "some text\n");
  EXPECT_EQ(files(), std::vector<std::string>{"b.octree"});
  done({"translate", "b.octree", "1,1,1", "-o", "t.octree"});
  EXPECT_EQ(done({"translate", "b.octree", "1,1,1", "-o", "-"}).out, read("t.octree"));
}

// A solid without any pattern, so that its file is larger than a pipe holds.
Octree noise() {
  return octree_from_classifier(7, [](const Cube& cube) {
    if (cube.level > 0) return Colour::gray;
    std::uint64_t hash = static_cast<std::uint64_t>(cube.x + 128 * (cube.y + 128 * cube.z)) * 0x9E3779B97F4A7C15u;
    hash = (hash ^ hash >> 29) * 0xBF58476D1CE4E5B9u;
    return hash >> 63 ? Colour::black : Colour::white;
  });
}

// Sends the signal while the program reads an octree from standard input; the rest of the octree follows.
class Interrupts : public CliTest {
 protected:
  void interrupt(std::vector<std::string> arguments, int signal_number) const;
};

void Interrupts::interrupt(std::vector<std::string> arguments, int signal_number) const {
  SCOPED_TRACE(testing::PrintToString(arguments) + " signal " + std::to_string(signal_number));
  arguments.insert(arguments.begin(), "blackleaf");
  std::vector<char*> argv;
  for (std::string& word : arguments) argv.push_back(word.data());
  argv.push_back(nullptr);
  const std::vector<std::uint8_t> bytes = to_bytes(noise());
  constexpr std::size_t kMoreThanAPipeHolds = 1 << 17;
  ASSERT_GT(bytes.size(), kMoreThanAPipeHolds);
  // A program that ends early makes a write fail, not the test die.
  signal(SIGPIPE, SIG_IGN);
  std::array<int, 2> input{};
  ASSERT_EQ(pipe2(input.data(), O_CLOEXEC), 0);
  const std::string err = folder().parent_path() / "err";
  const pid_t child = fork();
  if (child == 0) {
    const int err_file = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (chdir(folder().c_str()) != 0) _exit(125);
    signal(SIGPIPE, SIG_DFL);
    dup2(input[0], 0);
    dup2(err_file, 2);
    execv(BLACKLEAF_PROGRAM, argv.data());
    _exit(126);
  }
  close(input[0]);
  const auto send = [&](std::size_t from, std::size_t to) {
    while (from < to) {
      const ssize_t sent = ::write(input[1], bytes.data() + from, to - from);
      if (sent <= 0) return false;
      from += static_cast<std::size_t>(sent);
    }
    return true;
  };
  // Once more than a pipe holds is gone, the program is reading, so it watches for signals; it waits for the rest.
  ASSERT_TRUE(send(0, kMoreThanAPipeHolds));
  ASSERT_EQ(kill(child, signal_number), 0);
  // The program may be gone before it has read everything.
  send(kMoreThanAPipeHolds, bytes.size());
  close(input[1]);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 128 + signal_number);
  std::ifstream file(err);
  std::string message;
  std::getline(file, message);
  EXPECT_EQ(message, "blackleaf: interrupted; nothing was written");
  EXPECT_EQ(files(), std::vector<std::string>{});
}

TEST_F(Interrupts, LeaveNothing) {
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
    interrupt({"translate", "-", "1,0,0", "--clip", "-o", "o.octree"}, signal_number);
    interrupt({"export", "-", "-o", "o.nii.gz"}, signal_number);
    interrupt({"export", "-", "-o", "-"}, signal_number);
    interrupt({"draw", "-", "--view", "1,2,3", "-o", "o.svg"}, signal_number);
    interrupt({"info", "-"}, signal_number);
  }
}

// The signal comes while the output is made under its temporary name, or just before or after: whatever the moment, the
// output is there and the exit status 0, or neither, and the temporary is gone.
TEST_F(Interrupts, WhileWritingLeaveAllOrNothing) {
  save(noise(), folder() / "n.octree");
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP})
    for (const char* output : {"o.nii.gz", "o.nrrd", "o.ply", "o.runs"}) {
      SCOPED_TRACE(std::string(output) + " signal " + std::to_string(signal_number));
      const std::string err = folder().parent_path() / "err";
      const pid_t child = fork();
      if (child == 0) {
        const int err_file = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        if (chdir(folder().c_str()) != 0) _exit(125);
        dup2(err_file, 2);
        execl(BLACKLEAF_PROGRAM, "blackleaf", "export", "n.octree", "-o", output, "--quiet", nullptr);
        _exit(126);
      }
      int status = 0;
      bool ended = false;
      while (files().size() < 2 && !ended) ended = waitpid(child, &status, WNOHANG) == child;
      if (!ended) {
        kill(child, signal_number);
        ASSERT_EQ(waitpid(child, &status, 0), child);
      }
      ASSERT_TRUE(WIFEXITED(status));
      if (WEXITSTATUS(status) == 0) {
        EXPECT_EQ(files(), (std::vector<std::string>{"n.octree", output}));
      } else {
        EXPECT_EQ(WEXITSTATUS(status), 128 + signal_number);
        EXPECT_EQ(files(), std::vector<std::string>{"n.octree"});
      }
      std::filesystem::remove(folder() / output);
    }
}

TEST_F(Streams, FullOutputIsReported) {
  if (access("/dev/full", W_OK) != 0) GTEST_SKIP() << "this system has no /dev/full";
  make_box("b.octree", 4, {3, 4, 5}, {6, 7, 8});
  const std::string shell =
      "cd '" + folder().string() + "' && '" BLACKLEAF_PROGRAM "' info b.octree > /dev/full 2> ../err";
  const int status = std::system(shell.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 2);
  std::ifstream file(folder().parent_path() / "err");
  std::string message;
  std::getline(file, message);
  EXPECT_NE(message.find("blackleaf: cannot write to standard output"), std::string::npos) << message;
}

}  // namespace
}  // namespace blackleaf::test
