// A program told to stop puts no file in place, however far its making had come.
#include "blackleaf/drawing.h"
#include "blackleaf/drawing_file.h"
#include "blackleaf/error.h"
#include "blackleaf/implicit.h"
#include "blackleaf/mesh.h"
#include "blackleaf/mesh_file.h"
#include "blackleaf/octree_file.h"
#include "blackleaf/runs_file.h"
#include "blackleaf/volume_file.h"
#include "cli/run_command.h"
#include "file/stop_check.h"

namespace blackleaf::test {
namespace {

namespace fs = std::filesystem;

void stop() { throw Error(ErrorCode::cancelled, "stopped"); }

class StopCheck : public CliTest {
 protected:
  ~StopCheck() override { detail::set_stop_check(nullptr); }
};

TEST_F(StopCheck, NoWriterPutsAFileInPlace) {
  const Octree octree = box(4, {3, 4, 5}, {6, 7, 8});
  const auto write_to = [&](const fs::path& path) {
    const std::string suffix = path.extension();
    if (suffix == ".octree") return save(octree, path);
    if (suffix == ".runs") return write_runs(octree, path);
    if (suffix == ".stl" || suffix == ".obj" || suffix == ".ply") return write_mesh(boundary_mesh(octree), path);
    if (suffix == ".svg" || suffix == ".json" || suffix == ".png" || suffix == ".pdf")
      return write_drawing(draw(octree, View({1, 2, 3})), path);
    write_volume(octree, path);
  };
  for (const char* name : {"o.octree", "o.runs", "o.stl", "o.obj", "o.ply", "o.svg", "o.json", "o.png", "o.pdf",
                           "o.nrrd", "o.nii", "o.nii.gz", "o.mha"}) {
    SCOPED_TRACE(name);
    detail::set_stop_check(stop);
    for (const bool there : {false, true}) {
      if (there) write(name, "old");
      const std::vector<std::string> before = files();
      EXPECT_THROW(write_to(folder() / name), Error);
      EXPECT_EQ(files(), before);
      if (there) {
        EXPECT_EQ(read(name), "old");
      }
    }
    detail::set_stop_check(nullptr);
    write_to(folder() / name);
    EXPECT_NE(read(name), "old");
    EXPECT_EQ(files(), std::vector<std::string>{name});
    fs::remove(folder() / name);
  }
}

}  // namespace
}  // namespace blackleaf::test
