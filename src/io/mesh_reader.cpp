#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <system_error>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/mesh_file.h"
#include "file/input_file.h"
#include "io/header_text.h"
#include "io/isolated.h"
#include "io/mesh_checks.h"
#include "io/off_reader.h"
#include "io/polygon.h"
#include "io/stl_text_reader.h"

namespace blackleaf {
namespace {

// One line of assimp's reason.
std::string reason(const char* message) {
  std::string text;
  for (const char* c = message; *c; ++c) {
    const bool blank = std::isspace(static_cast<unsigned char>(*c)) || static_cast<unsigned char>(*c) < 0x20;
    if (!blank)
      text += *c;
    else if (!text.empty() && text.back() != ' ')
      text += ' ';
  }
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  if (text.size() > 200) text = text.substr(0, 200) + "...";
  return text.empty() ? "no reason given" : text;
}

// Puts the parts of a scene together, each as often as the scene's nodes refer to it.
class SceneReader {
 public:
  SceneReader(const aiScene& scene, std::string name) : scene_(scene), name_(std::move(name)) {}

  TriangleMesh read() {
    add(*scene_.mRootNode, Transform{Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero(), true}, 0);
    if (mesh_.triangles.empty()) fail("has no triangles", "give a surface, not points or lines");
    return std::move(mesh_);
  }

 private:
  struct Transform {
    Eigen::Matrix3d linear;
    Eigen::Vector3d shift;
    bool identity;  // then positions stay as they are, bit for bit
  };

  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw Error(ErrorCode::bad_input, fmt::format("{}: {}", name_, what), remedy);
  }

  void add(const aiNode& node, const Transform& parent, int depth) {
    constexpr int kDeepest = 1000;  // far more than modelling needs; keeps the recursion on the stack
    if (depth > kDeepest) fail("has parts nested more than 1000 deep", "flatten it first");
    Transform transform = parent;
    const aiMatrix4x4& m = node.mTransformation;
    if (!m.IsIdentity()) {
      Eigen::Matrix3d linear;
      linear << m.a1, m.a2, m.a3, m.b1, m.b2, m.b3, m.c1, m.c2, m.c3;
      transform.shift = parent.linear * Eigen::Vector3d(m.a4, m.b4, m.c4) + parent.shift;
      transform.linear = parent.linear * linear;
      transform.identity = false;
    }
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      if (node.mMeshes[i] >= scene_.mNumMeshes) fail("refers to a part that it does not have", "export it again");
      add(*scene_.mMeshes[node.mMeshes[i]], transform);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) add(*node.mChildren[i], transform, depth + 1);
  }

  void add(const aiMesh& part, const Transform& transform) {
    const std::size_t first = mesh_.vertices.size();
    if (part.mNumVertices > std::numeric_limits<std::uint32_t>::max() - first)
      fail("has 2^32 vertices or more", "simplify it first");
    std::vector<bool> used(part.mNumVertices, false);
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      if (face.mNumIndices < 3) continue;  // points and lines bound nothing
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        if (face.mIndices[k] >= part.mNumVertices)
          fail(fmt::format("a face refers to vertex {} of {}", face.mIndices[k], part.mNumVertices), "export it again");
        used[face.mIndices[k]] = true;
      }
    }
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D& v = part.mVertices[i];
      Eigen::Vector3d position(v.x, v.y, v.z);
      if (!transform.identity) position = transform.linear * position + transform.shift;
      if (!position.allFinite()) {
        if (used[i])
          fail(fmt::format("vertex {} is not finite, or too large for single precision", first + i), "export it again");
        position.setZero();  // nothing refers to it
      }
      mesh_.vertices.push_back(position);
    }
    std::vector<std::uint32_t> corners;
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      if (face.mNumIndices < 3) continue;
      corners.clear();
      for (unsigned k = 0; k < face.mNumIndices; ++k)
        corners.push_back(static_cast<std::uint32_t>(first + face.mIndices[k]));
      detail::append_polygon(mesh_.vertices, corners, mesh_.triangles);
    }
  }

  const aiScene& scene_;
  const std::string name_;
  TriangleMesh mesh_;
};

// Through assimp, which damaged files can crash, keep busy for ever, or make use any amount of memory.
TriangleMesh read_with_assimp(const std::string& name) {
  Assimp::Importer importer;
  const aiScene* scene = nullptr;
  std::string why;
  try {
    // Nothing that moves vertices: no joining, no rescaling, no pre-transformation in single precision. And no
    // triangulation: assimp's drops what remains of a polygon that it cannot cut.
    scene = importer.ReadFile(name, 0);
    why = reason(importer.GetErrorString());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& exception) {
    why = reason(exception.what());
  }
  if (!scene || !scene->mRootNode) {
    if (why.find("bad_alloc") != std::string::npos) throw std::bad_alloc();  // assimp has turned it into a text
    throw Error(ErrorCode::bad_input, fmt::format("{}: cannot be read as a mesh: {}", name, why),
                "use STL, OBJ, PLY, OFF, glTF or 3MF");
  }
  return SceneReader(*scene, name).read();
}

// What comes back from the process that reads: this, then the vertices and triangles or the text of the error.
struct AnswerHead {
  std::uint64_t vertices = 0, triangles = 0;
  std::uint64_t error_size = 0;  // bytes of the text; 0 when there is none
  ErrorCode code = ErrorCode::bad_input;
  std::uint32_t unused = 0;
};
static_assert(sizeof(AnswerHead) == 32 && sizeof(Eigen::Vector3d) == 24);

void answer_mesh(const std::string& name, const detail::Answer& answer) {
  AnswerHead head;
  try {
    const TriangleMesh mesh = read_with_assimp(name);
    head.vertices = mesh.vertices.size();
    head.triangles = mesh.triangles.size();
    answer.write(&head, sizeof head);
    answer.write(mesh.vertices.data(), mesh.vertices.size() * sizeof mesh.vertices[0]);
    answer.write(mesh.triangles.data(), mesh.triangles.size() * sizeof mesh.triangles[0]);
  } catch (const Error& error) {
    const std::string text = error.what();
    head.error_size = text.size();
    head.code = error.code();
    answer.write(&head, sizeof head);
    answer.write(text.data(), text.size());
  }
}

// Bytes that reading goes through: those of the file, unpacked, and of the files beside it that glTF refers to.
std::uint64_t bytes_to_read(const std::filesystem::path& path, std::uint64_t size) {
  const std::string suffix = detail::lower(path.extension().string());
  if (suffix == ".3mf" || suffix == ".zae") return 16 * size;
  if (suffix != ".gltf") return size;
  std::error_code error;
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  for (std::filesystem::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
    std::error_code none;
    if (i->path().extension() != ".bin" || !i->is_regular_file(none)) continue;
    if (const std::uint64_t more = i->file_size(none); !none) size += more;
  }
  return size;
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& path) {
  const std::string name = path.string();
  detail::IsolatedLimits limits;
  {
    const detail::InputFile file(path);
    if (!file.is_regular()) throw Error(ErrorCode::io, name + ": is not an ordinary file", "copy it to one first");
    if (file.size() == 0) throw Error(ErrorCode::bad_input, name + ": is empty", "get it again from its source");
    if (detail::lower(path.extension().string()) == ".off") return detail::read_off(file, name);
    if (detail::is_stl_text(file, path)) return detail::read_stl_text(file, name);
    detail::check_mesh_file(file, path);
    const std::uint64_t bytes = bytes_to_read(path, file.size());
    limits.memory = (std::uint64_t{2} << 30) + 64 * bytes;
    limits.seconds = 10 + (bytes >> 20);
  }
  detail::Isolated child(limits, [&](const detail::Answer& answer) { answer_mesh(name, answer); });
  AnswerHead head;
  TriangleMesh mesh;
  std::string text;
  if (!child.read(&head, sizeof head) || !detail::read_items(child, head.error_size, text) ||
      !detail::read_items(child, head.vertices, mesh.vertices) ||
      !detail::read_items(child, head.triangles, mesh.triangles)) {
    if (child.interrupted()) throw Error(ErrorCode::cancelled, name + ": reading it was interrupted");
    throw Error(ErrorCode::bad_input, name + ": is damaged or too much for the reader of its format, which ended",
                "get it again from its source, or save it as PLY or STL");
  }
  if (head.error_size > 0) throw Error(head.code, text);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle)
      if (vertex >= mesh.vertices.size())
        throw Error(ErrorCode::bad_input,
                    fmt::format("{}: a face refers to vertex {} of {}", name, vertex, mesh.vertices.size()),
                    "export it again");
  return mesh;
}

}  // namespace blackleaf
