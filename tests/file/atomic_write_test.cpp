#include "file/atomic_write.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>

#include "blackleaf/implicit.h"
#include "blackleaf/octree_file.h"
#include "temporary_folder.h"

namespace blackleaf {
namespace {

namespace fs = std::filesystem;
using detail::AtomicFile;
using detail::write_atomically;
using test::expect_error;
using Names = std::vector<std::string>;

TEST(AtomicWrite, ReplacesTheOldFileOrNothing) {
  const test::TemporaryFolder folder;
  write_atomically(folder / "a", std::string_view("old"));
  {
    AtomicFile file(folder / "a");
    EXPECT_EQ(file.temporary().parent_path(), folder.path());
    file.write(std::vector<std::uint8_t>{'n', 'e'});
    EXPECT_EQ(test::read_text(folder / "a"), "old");
    EXPECT_EQ(folder.names().size(), 2u);
  }
  EXPECT_EQ(test::read_text(folder / "a"), "old");
  EXPECT_EQ(folder.names(), Names{"a"});
  AtomicFile file(folder / "a");
  file.write(std::vector<std::uint8_t>{'n', 'e', 'w'});
  file.commit();
  EXPECT_EQ(test::read_text(folder / "a"), "new");
  EXPECT_EQ(folder.names(), Names{"a"});
}

TEST(AtomicWrite, LibrariesMayReplaceTheTemporary) {
  const test::TemporaryFolder folder;
  AtomicFile file(folder / "volume.nii.gz", ".nii.gz");
  EXPECT_TRUE(file.temporary().string().ends_with(".nii.gz"));
  fs::remove(file.temporary());
  test::write_file(file.temporary(), "by a library");
  file.commit();
  EXPECT_EQ(test::read_text(folder / "volume.nii.gz"), "by a library");
  EXPECT_EQ(folder.names(), Names{"volume.nii.gz"});
  AtomicFile lost(folder / "volume.nii.gz");
  fs::remove(lost.temporary());
  expect_error(ErrorCode::io, {"volume.nii.gz: cannot be written"}, [&] { lost.commit(); });
}

TEST(AtomicWrite, TemporariesAreUnique) {
  const test::TemporaryFolder folder;
  AtomicFile a(folder / "a"), b(folder / "a");
  EXPECT_NE(a.temporary(), b.temporary());
  a.commit();
  b.commit();
  EXPECT_EQ(folder.names(), Names{"a"});
}

TEST(AtomicWrite, FollowsSymbolicLinks) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder / "real");
  test::write_file(folder / "real" / "data", "old");
  fs::create_symlink("real/data", folder / "link");
  fs::create_symlink("link", folder / "link to link");
  write_atomically(folder / "link to link", std::string_view("new"));
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_TRUE(fs::is_symlink(folder / "link to link"));
  EXPECT_EQ(test::read_text(folder / "real" / "data"), "new");
  fs::create_symlink("real/not yet", folder / "dangling");
  write_atomically(folder / "dangling", std::string_view("made"));
  EXPECT_EQ(test::read_text(folder / "real" / "not yet"), "made");
  fs::create_symlink("circle 2", folder / "circle 1");
  fs::create_symlink("circle 1", folder / "circle 2");
  expect_error(ErrorCode::io, {"circle 1: cannot be written"},
               [&] { write_atomically(folder / "circle 1", std::string_view("x")); });
}

TEST(AtomicWrite, KeepsPermissions) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a", "old");
  ::chmod((folder / "a").c_str(), 0640);
  write_atomically(folder / "a", std::string_view("new"));
  struct stat status {};
  ASSERT_EQ(::stat((folder / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0640u);
  const mode_t old_mask = ::umask(027);
  write_atomically(folder / "b", std::string_view("new"));
  ::umask(old_mask);
  ASSERT_EQ(::stat((folder / "b").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0640u);
}

TEST(AtomicWrite, ImpossibleTargets) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder / "sub");
  test::write_file(folder / "file", "kept");
  const auto refuse = [&](const fs::path& path, const std::vector<std::string>& pieces) {
    expect_error(ErrorCode::io, pieces, [&] { write_atomically(path, std::string_view("x")); });
  };
  refuse(folder / "sub", {"sub: cannot be written", "name a file in it"});
  refuse(folder / "no" / "a", {"a: cannot be written", "create the folder first"});
  refuse(folder / "file" / "a", {"a: cannot be written"});
  refuse("", {"cannot be written"});
  refuse(folder / std::string(300, 'x'), {"cannot be written"});
  if (::geteuid() != 0) {
    ::chmod((folder / "file").c_str(), 0444);
    refuse(folder / "file", {"write-protected"});
    ::chmod((folder / "sub").c_str(), 0555);
    refuse(folder / "sub" / "a", {"a: cannot be written", "choose a folder"});
    ::chmod((folder / "sub").c_str(), 0755);
  }
  EXPECT_EQ(folder.names(), (Names{"file", "sub"}));
  EXPECT_EQ(test::read_text(folder / "file"), "kept");
}

TEST(AtomicWrite, DevicesAreWrittenDirectly) {
  write_atomically("/dev/null", std::string_view("x"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  expect_error(ErrorCode::io, {"/dev/null: cannot be written: it is a device"}, [] { AtomicFile file("/dev/null"); });
  expect_error(ErrorCode::io, {"/dev/full: cannot be written", "make room"},
               [] { write_atomically("/dev/full", std::string_view("x")); });
}

// The disk fills up halfway: the old file stays as it was and nothing else is left.
TEST(AtomicWrite, FailingMidway) {
  const test::TemporaryFolder folder;
  const Octree old = box(4, {1, 2, 3}, {5, 6, 7});
  save(old, folder / "a.octree");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit = before;
  limit.rlim_cur = 1000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  expect_error(ErrorCode::io, {"a.octree: cannot be written"}, [&] {
    save(ball(8, {128, 128, 128}, 100), folder / "a.octree");
  });
  expect_error(ErrorCode::io, {"b.octree: cannot be written"}, [&] {
    save(ball(8, {128, 128, 128}, 100), folder / "b.octree");
  });
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(folder.names(), Names{"a.octree"});
  EXPECT_TRUE(load(folder / "a.octree").octree == old);
}

}  // namespace
}  // namespace blackleaf
