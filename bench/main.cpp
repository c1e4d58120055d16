#include <cstdio>
#include <exception>

#include "contenders.h"

int main(int argc, char** argv) {
  using namespace blackleaf::bench;
  add_voxels();
  add_mesh();
  add_translate();
  add_move();
  add_combine();
  add_offset();
  add_sweep();
  add_interference();
  add_distance();
  add_query();
  add_drawing();
  add_curve();
  add_file();
  add_labels();
  add_plan();
  add_scanline();
  add_openvdb();
  add_openvdb_translate();
  add_openvdb_sets();
  add_octomap();
  add_fcl();
  add_opencascade();
  add_fcl_plan();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  try {
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "blackleaf_bench: %s\n", error.what());
    return 2;
  }
  return 0;
}
