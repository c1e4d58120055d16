#include "blackleaf/points_file.h"

#include <algorithm>
#include <array>

#include "blackleaf/mesh_file.h"
#include "io/file_text.h"
#include "io/ply_header.h"
#include "io/point_readers.h"

namespace blackleaf {
namespace {

std::string suffix_of(const std::filesystem::path& path) { return detail::lower(path.extension().string()); }

bool is_text(const std::string& suffix) {
  constexpr std::array<const char*, 7> kText = {".xyz", ".xyzn", ".xyzrgb", ".pts", ".asc", ".txt", ".csv"};
  return std::find(kText.begin(), kText.end(), suffix) != kText.end();
}

}  // namespace

bool is_point_cloud(const std::filesystem::path& path) {
  const std::string suffix = suffix_of(path);
  if (suffix == ".pcd" || is_text(suffix)) return true;
  if (suffix != ".ply") return false;
  const detail::InputFile file(path);
  if (!file.is_regular()) return false;
  const std::optional<detail::PlyHeader> header = detail::read_ply_header(file, path.string());
  if (!header) return false;
  return std::none_of(header->elements.begin(), header->elements.end(), [](const detail::PlyElement& element) {
    return (element.name == "face" || element.name == "tristrips") && element.count > 0;
  });
}

PointsInfo read_points(const std::filesystem::path& path,
                       const std::function<void(std::span<const Eigen::Vector3d>)>& take, const Work& work) {
  const std::string suffix = suffix_of(path), name = path.string();
  if (suffix != ".ply" && suffix != ".pcd" && !is_text(suffix)) {
    const TriangleMesh mesh = read_mesh(path);
    detail::PointSink sink(take, work, 0);
    for (const Eigen::Vector3d& vertex : mesh.vertices) sink.add(vertex);
    return sink.finish();
  }
  const detail::InputFile file(path);
  if (!file.is_regular()) throw Error(ErrorCode::io, name + ": is not an ordinary file", "copy it to one first");
  if (file.size() == 0) throw Error(ErrorCode::bad_input, name + ": is empty", "get it again from its source");
  detail::PointSink sink(take, work, file.size());
  if (suffix == ".ply")
    detail::read_ply_points(file, name, sink);
  else if (suffix == ".pcd")
    detail::read_pcd_points(file, name, sink);
  else
    detail::read_text_points(file, name, sink);
  return sink.finish();
}

}  // namespace blackleaf
