#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/mesh_file.h"
#include "file/input_file.h"

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
      if (face.mNumIndices != 3) continue;  // points and lines bound nothing; polygons have been triangulated
      std::array<std::uint32_t, 3> triangle{};
      for (unsigned k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= part.mNumVertices)
          fail(fmt::format("a face refers to vertex {} of {}", face.mIndices[k], part.mNumVertices), "export it again");
        used[face.mIndices[k]] = true;
        triangle[k] = static_cast<std::uint32_t>(first + face.mIndices[k]);
      }
      mesh_.triangles.push_back(triangle);
    }
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D& v = part.mVertices[i];
      Eigen::Vector3d position(v.x, v.y, v.z);
      if (!transform.identity) position = transform.linear * position + transform.shift;
      if (!position.allFinite()) {
        if (used[i]) fail(fmt::format("vertex {} is not finite", first + i), "export it again");
        position.setZero();  // nothing refers to it
      }
      mesh_.vertices.push_back(position);
    }
  }

  const aiScene& scene_;
  const std::string name_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& path) {
  const std::string name = path.string();
  if (const detail::InputFile file(path); !file.is_regular()) {
    throw Error(ErrorCode::io, name + ": is not an ordinary file", "copy it to one first");
  } else if (file.size() == 0) {
    throw Error(ErrorCode::bad_input, name + ": is empty", "get it again from its source");
  }
  Assimp::Importer importer;
  const aiScene* scene = nullptr;
  std::string why;
  try {
    // Nothing that moves vertices: no joining, no rescaling, no pre-transformation in single precision.
    scene = importer.ReadFile(name, aiProcess_Triangulate);
    why = reason(importer.GetErrorString());
  } catch (const std::exception& exception) {
    why = reason(exception.what());
  }
  if (!scene || !scene->mRootNode)
    throw Error(ErrorCode::bad_input, fmt::format("{}: cannot be read as a mesh: {}", name, why),
                "use STL, OBJ, PLY, OFF, glTF or 3MF");
  return SceneReader(*scene, name).read();
}

}  // namespace blackleaf
