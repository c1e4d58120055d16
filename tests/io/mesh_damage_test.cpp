// Damaged meshes: each is refused with one clear line, in this process, which goes on as if nothing had been.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>
#include <thread>

#include "blackleaf/implicit.h"
#include "blackleaf/mesh_file.h"
#include "file/stop_check.h"
#include "file/temporary_folder.h"
#include "io/isolated.h"
#include "reference/dense_grid.h"
#include "reference/memory_limits.h"

namespace blackleaf {
namespace {

using test::expect_error;

const std::string kTetrahedron = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const std::string kPlyHeader =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos);
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

class MeshDamage : public testing::Test {
 protected:
  void refuse(const std::string& name, std::string_view contents, std::vector<std::string> pieces) {
    SCOPED_TRACE(testing::Message() << name << ", " << contents.size() << " bytes");
    test::write_file(folder_ / name, contents);
    pieces.push_back(name);
    expect_error(ErrorCode::bad_input, pieces, [&] { read_mesh(folder_ / name); });
    no_child_left();
  }
  std::size_t triangles(const std::string& name, std::string_view contents) {
    test::write_file(folder_ / name, contents);
    return read_mesh(folder_ / name).triangles.size();
  }
  static void no_child_left() {
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
  }
  std::string written(const std::string& name) {
    std::mt19937 random(7);
    write_mesh(boundary_mesh(reference::octree(reference::random_solid(3, random))), folder_ / name);
    return test::read_text(folder_ / name);
  }

  test::TemporaryFolder folder_;
};

TEST_F(MeshDamage, BinaryPlyCutAnywhere) {
  const std::string whole = written("whole.ply");
  const std::size_t header = whole.find("end_header\n") + 11;
  for (std::size_t length = 4; length < header - 1; length += 7)
    refuse("a.ply", whole.substr(0, length), {"end_header", "cut off"});
  for (std::size_t length = header; length < whole.size(); length += 1 + length / 20)
    refuse("a.ply", whole.substr(0, length), {"its header tells of", "cut off"});
  refuse("a.ply", whole.substr(0, whole.size() - 1), {"\"face\"", "cut off"});
  refuse("a.ply", replaced(whole, "element face ", "element face 9"), {"\"face\"", "cut off"});
  EXPECT_GT(triangles("a.ply", whole), 0u);
}

TEST_F(MeshDamage, BinaryPlyWithMoreThanItTellsOf) {
  const std::string whole = written("whole.ply");
  const std::size_t faces = triangles("a.ply", whole);
  EXPECT_EQ(triangles("a.ply", whole + std::string(12, '\0')), faces) << "padding, shorter than a triangle";
  refuse("a.ply", whole + std::string(13, '\0'), {"\"face\" but there are 13 bytes behind them"});
  refuse("a.ply", whole + whole, {"mend the numbers in its header"});
}

TEST_F(MeshDamage, TextPly) {
  const std::string whole = kPlyHeader + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(triangles("a.ply", whole), 1u);
  EXPECT_EQ(triangles("a.ply", whole.substr(0, whole.size() - 1)), 1u);
  refuse("a.ply", replaced(whole, "vertex 3", "vertex 99999999"), {"99999999 of \"vertex\"", "there are 4"});
  refuse("a.ply", replaced(whole, "face 1", "face 2"), {"2 of \"face\"", "there are 1"});
  refuse("a.ply", replaced(whole, "face 1", "face -1"), {"no good count"});
  refuse("a.ply", replaced(whole, "0 1 2", "0 1 3"), {"vertex 3"});
  refuse("a.ply", replaced(whole, "3 0 1 2", "3 0 1"), {"\"face\" 0 has 3 numbers instead of 4", "cut off"});
  refuse("a.ply", replaced(whole, "3 0 1 2", "4 0 1 2"), {"\"face\" 0 has 4 numbers instead of 5"});
  refuse("a.ply", replaced(whole, "1 0 0", "1 0"), {"\"vertex\" 1 has 2 numbers instead of 3", "damaged"});
  refuse("a.ply", whole.substr(0, 20), {"end_header"});
  refuse("a.ply", replaced(whole, "end_header", std::string(70000, 'x')), {"in its first 64 KiB"});
}

TEST_F(MeshDamage, Stl) {
  const std::string whole = written("whole.stl");
  const std::string size = std::to_string(whole.size()), triangles_there = std::to_string((whole.size() - 84) / 50);
  refuse("a.stl", whole.substr(0, whole.size() / 2),
         {"its header tells of " + triangles_there + " triangles (" + size + " bytes) but there are " +
              std::to_string(whole.size() / 2) + " bytes",
          "the file was cut off, get it again"});
  refuse("a.stl", whole + "and more", {"(" + size + " bytes)", "damaged"});
  refuse("a.STL", whole.substr(0, 84), {"cut off"});
  EXPECT_EQ(triangles("a.stl",
                      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                      "endloop\nendfacet\nendsolid a\n"),
            1u);
  const std::string corners = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
  const auto facet = [](const std::string& vertices) {
    return "facet normal 0 0 1\nouter loop\n" + vertices + "\nendloop\nendfacet\n";
  };
  EXPECT_EQ(triangles("a.stl",
                      "solid facet 7 vertex\r" + facet(corners) + "endsolid\nSOLID b\n" + facet(corners) + "EndSolid"),
            2u);
  refuse("a.stl",
         "solid a\n" + facet(corners) + "facet normal 0 0 1\n" + "outer loop\n" + corners + "endloop\nendfacet\n",
         {"no endsolid", "cut off"});
  refuse("a.stl", "solid a\n" + facet(corners + "vertex 1 1 0\n") + "endsolid a\n",
         {"facet 0 has 4 vertices", "divide it into triangles"});
  refuse("a.stl", "solid a\n" + facet(corners) + facet(corners.substr(0, 26)) + "endsolid a\n",
         {"facet 1 has 2 vertices", "damaged"});
  refuse("a.stl", "solid a\n" + facet(corners) + "facet normal 0 0 1\nouter loop\nvertex 0 0 0\n",
         {"facet 1 has 1 vertices", "cut off"});
  refuse("a.stl", "solid a\n" + facet(corners) + corners + "endsolid a\n", {"a vertex outside a facet before facet 1"});
  refuse("a.stl", "solid a\n" + facet(corners.substr(0, 26) + "vertex 1 zero 0") + "endsolid a\n",
         {"facet 0", "'zero'"});
  refuse("a.stl", "solid a\n" + facet(corners.substr(0, 26) + "vertex 1 2") + "endsolid a\n", {"facet 0", "'endloop'"});
  refuse("a.stl", "solid a\n" + facet(corners.substr(0, 26) + "vertex 1 2 nan") + "endsolid a\n", {"'nan'", "finite"});
  refuse("a.stl", "solid a\n" + facet(corners.substr(0, 26) + "vertex 1 2 1e999") + "endsolid a\n", {"'1e999'"});
  refuse("a.stl", "solid a\nendsolid a\n", {"has no triangles"});
  test::write_file(folder_ / "a.stl",
                   "SOLID a\n" + facet("VERTEX 0.1 -2E-3\n+1e300 vertex 1 1e-999 0 vertex 7 8 9") + "endsolid");
  EXPECT_EQ(read_mesh(folder_ / "a.stl").vertices,
            (std::vector<Eigen::Vector3d>{{0.1, -2e-3, 1e300}, {1, 0, 0}, {7, 8, 9}}));
  std::string solid = whole;  // some programs begin binary files so, too
  solid.replace(0, 5, "solid");
  EXPECT_EQ(triangles("a.stl", solid), (whole.size() - 84) / 50);
}

TEST_F(MeshDamage, Obj) {
  const std::string whole =
      "# v 1\nv 0 0 0\nv 1 0 0 1\n v +0 1 -.5e0 1 0 0\nvt 0 0\nvn 0 0 1\nv \\\n0 0 7\nv 0 0 9\nf 1 2 3\n";
  EXPECT_EQ(triangles("a.obj", whole), 1u);
  refuse("a.obj", replaced(whole, "v 0 0 9", "v 0 9"), {"vertex 5 has 2 coordinates ('v 0 9')", "3, 4 or"});
  refuse("a.obj", replaced(whole, "v 0 0 0", "v 0 zero 0"), {"vertex 1 has 1 coordinates"});
  refuse("a.obj", replaced(whole, "v 0 0 0", "v 0 0 0 1 2"), {"vertex 1 has 5 coordinates"});
  refuse("a.obj", replaced(whole, "v 0 0 0", "v 0 nan 0"), {"vertex", "not finite"});
  refuse("a.obj", replaced(whole, "f 1 2 3", "f 1 2 9"), {"out of range"});
}

// Bytes changed at random: an answer or an Error, whatever assimp makes of them.
TEST_F(MeshDamage, ChangedBytes) {
  std::mt19937 random(41);
  const std::vector<std::pair<std::string, std::string>> files = {
      {"a.off", kTetrahedron},
      {"a.ply", kPlyHeader + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"b.ply", written("b.ply")},
      {"a.stl", written("a.stl")},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"}};
  for (int i = 0; i < 100; ++i)
    for (const auto& [name, whole] : files) {
      SCOPED_TRACE(testing::Message() << name << " " << i);
      std::string changed = whole;
      for (unsigned k = 0; k <= random() % 3; ++k)
        changed[random() % std::min<std::size_t>(changed.size(), 500)] = static_cast<char>(random() % 128);
      test::write_file(folder_ / name, changed);
      try {
        const TriangleMesh mesh = read_mesh(folder_ / name);
        for (const auto& triangle : mesh.triangles)
          for (const auto vertex : triangle) ASSERT_LT(vertex, mesh.vertices.size());
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      }
    }
  no_child_left();
}

// Many threads that read and allocate while others fork: each child gets a heap in order, each reader its own answer.
TEST_F(MeshDamage, ManyThreadsAtOnce) {
#ifdef __SANITIZE_ADDRESS__
  // gcc 12's does not hold its allocator's locks across a fork, so a child may wait for a thread that it has not.
  GTEST_SKIP() << "the address sanitizer's allocator cannot be used after a fork beside other threads";
#endif
  const std::string whole = written("whole.ply");
  test::write_file(folder_ / "cut.ply", replaced(whole, "element face ", "element face 9"));
  const std::size_t wanted = read_mesh(folder_ / "whole.ply").triangles.size();
  std::atomic<int> wrong = 0, refused = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (int i = 0; i < 25; ++i) {
        if (read_mesh(folder_ / "whole.ply").triangles.size() != wanted) ++wrong;
        try {
          read_mesh(folder_ / "cut.ply");
        } catch (const Error&) {
          ++refused;
        }
      }
    });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(refused, 100);
  no_child_left();
}

// Whatever becomes of the child, the parent sees a short answer and has no process left.
TEST(MeshIsolated, EndsOfAllKinds) {
  const detail::IsolatedLimits limits{std::uint64_t{1} << 30, 1};
  const auto answer = [&](const std::function<void(const detail::Answer&)>& work, bool wanted_interrupted) {
    {
      detail::Isolated child(limits, work);
      std::array<char, 4> bytes{};
      EXPECT_TRUE(child.read(bytes.data(), 2));
      EXPECT_EQ(std::string(bytes.data()), "ok");
      EXPECT_FALSE(child.read(bytes.data(), 1));
      EXPECT_EQ(child.interrupted(), wanted_interrupted);
    }
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  };
  answer([](const auto& to) { to.write("ok", 2); }, false);
  answer([](const auto& to) { to.write("ok", 2), throw std::runtime_error("no"); }, false);
  answer([](const auto& to) { to.write("ok", 2), std::abort(); }, false);
  answer([](const auto& to) { to.write("ok", 2), static_cast<void>(raise(SIGSEGV)); }, false);
  answer([](const auto& to) { to.write("ok", 2), static_cast<void>(raise(SIGINT)); }, true);
  answer(
      [](const auto& to) {
        to.write("ok", 2);
        for (volatile bool forever = true; forever;) continue;
      },
      false);
  if (test::kMemoryLimits)
    answer(
        [](const auto& to) {
          to.write("ok", 2);
          for (std::vector<std::string> all;;) all.emplace_back(std::size_t{1} << 28, 'x');
        },
        false);
}

std::atomic<bool> told_to_stop{false};

// Told to stop before and during the wait for a child that does not answer: the wait ends, and so does the child.
TEST(MeshIsolated, StopsWhenTold) {
  detail::set_stop_check([] {
    if (told_to_stop) throw Error(ErrorCode::cancelled, "interrupted");
  });
  for (const int delay : {0, 30}) {
    SCOPED_TRACE(delay);
    told_to_stop = false;
    std::thread stopper([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(delay));
      told_to_stop = true;
    });
    expect_error(ErrorCode::cancelled, {"interrupted"}, [] {
      detail::Isolated child({std::uint64_t{1} << 30, 100}, [](const auto&) { sleep(1000); });
      char byte = 0;
      child.read(&byte, 1);
    });
    stopper.join();
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  }
  told_to_stop = true;
  const test::TemporaryFolder folder;
  for (const char* name : {"a.off", "a.obj"}) {
    test::write_file(folder / name, kTetrahedron);
    expect_error(ErrorCode::cancelled, {"interrupted"}, [&] { read_mesh(folder / name); });
  }
  detail::set_stop_check(nullptr);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
}

// An answer larger than a pipe holds, read in pieces; and one that nobody reads.
TEST(MeshIsolated, LongAnswers) {
  const std::string text(5'000'000, 'a');
  const auto work = [&](const detail::Answer& to) { to.write(text.data(), text.size()); };
  {
    detail::Isolated child({std::uint64_t{1} << 30, 100}, work);
    std::string read(text.size(), ' ');
    for (std::size_t at = 0; at < text.size(); at += 1'000'000) ASSERT_TRUE(child.read(read.data() + at, 1'000'000));
    EXPECT_EQ(read, text);
  }
  { const detail::Isolated unread({std::uint64_t{1} << 30, 100}, work); }
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
}

}  // namespace
}  // namespace blackleaf
