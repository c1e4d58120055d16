// blackleaf build: silhouettes.
#include "blackleaf/silhouettes_file.h"
#include "build.h"
#include "files.h"

namespace blackleaf::cli {

Octree build_silhouettes(Session& session, const BuildOptions& o, const std::optional<Octree>& like, Json& facts) {
  const std::optional<int> depth = like ? std::optional(like->depth()) : o.depth;
  if (like) facts["like"] = base_name(*o.like);
  const SilhouetteSet set = session.stage("read", [&](const Work&) { return read_silhouettes(o.input, depth); });
  facts["depth"] = set.depth;
  facts["silhouettes"] = set.silhouettes.size();
  return session.stage("build", [&](const Work& work) {
    return naming(o.input, [&] {
      return octree_from_silhouettes(set.silhouettes, set.depth, like ? like->frame() : Frame{}, work);
    });
  });
}

}  // namespace blackleaf::cli
