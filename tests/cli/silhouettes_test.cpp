// blackleaf build from silhouettes, and the objects of VA88 from the images that examples/va88 draws.
#include <cstdlib>

#include "blackleaf/octree_file.h"
#include "cli/run_command.h"

namespace blackleaf::test {
namespace {

class SilhouettesCommand : public CliTest {
 protected:
  void draw_images() const {
    const std::string command = "python3 '" BLACKLEAF_EXAMPLES "/va88/make_silhouettes.py' '" + folder().string() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);  // NOLINT(cert-env33-c,concurrency-mt-unsafe): a test's own folder
  }
  Octree build(const std::string& input) const {
    done({"build", input, "-o", "o.octree"});
    return load(folder() / "o.octree").octree;
  }
  // Every voxel against a rule on q = 2 centre - 128, by axis.
  template <class Rule>
  void expect(const std::string& input, const Rule& rule) const {
    const Octree octree = build(input);
    ASSERT_EQ(octree.depth(), 7);
    std::size_t wrong = 0, black = 0;
    for (int z = 0; z < 128; ++z)
      for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
          const bool expected = rule(2 * x - 127, 2 * y - 127, 2 * z - 127);
          black += expected;
          wrong += expected != octree.contains(x, y, z);
        }
    EXPECT_EQ(wrong, 0u) << input;
    EXPECT_GT(black, 200'000u) << input;
  }
};

TEST_F(SilhouettesCommand, TheObjectsOfVa88) {
  draw_images();
  expect("cylinder.json", [](int x, int y, int z) { return x * x + y * y <= 80 * 80 && std::abs(z) <= 96; });
  expect("pyramid.json",
         [](int x, int y, int z) { return std::abs(z) <= 96 && 2 * std::max(std::abs(x), std::abs(y)) <= 96 - z; });
  // The paper's diamond, whose silhouette is one from every face of the universe: a rhombic dodecahedron.
  expect("diamond.json", [](int x, int y, int z) {
    const int a = std::abs(x), b = std::abs(y), c = std::abs(z);
    return a + b <= 112 && b + c <= 112 && c + a <= 112;
  });
  expect("cup.json", [](int x, int y, int z) {
    const auto body = [&](int u) { return std::abs(z) <= 84 && 14 * std::abs(u) <= 14 * 56 + z + 84; };
    const int ring = (x - 64) * (x - 64) + z * z;
    const bool handle = x >= 56 && ring >= 30 * 30 && ring <= 46 * 46;
    const bool strip = x >= 0 && x <= 110 && std::abs(y) <= 12;
    return (body(x) || handle) && body(y) && (x * x + y * y <= 68 * 68 || strip);
  });
}

TEST_F(SilhouettesCommand, RoundObjectsComeOutRoundFromManyViews) {
  draw_images();
  const Octree sphere = build("sphere.toml"), cone = build("cone.json");
  std::size_t missing = 0, ball = 0, far = 0;
  for (int z = 0; z < 128; ++z)
    for (int y = 0; y < 128; ++y)
      for (int x = 0; x < 128; ++x) {
        const int a = 2 * x - 127, b = 2 * y - 127, c = 2 * z - 127, square = a * a + b * b + c * c;
        ball += square <= 108 * 108;
        // Half a pixel may be lost where a view is not along an axis; nothing else of the ball is.
        missing += square <= 108 * 108 && !sphere.contains(x, y, z);
        far += square > 120 * 120 && sphere.contains(x, y, z);
        // Slices of the cone are discs of the cone's radius there, but for what eight views cannot see.
        const int room = 96 - c, square_4 = 4 * (a * a + b * b);
        if (a == 1 && b == 1) {
          ASSERT_EQ(cone.contains(x, y, z), c >= -96 && c <= 94) << z;
        }
        if (c >= -96 && room >= 4 && square_4 <= (room - 4) * (room - 4)) {
          ASSERT_TRUE(cone.contains(x, y, z)) << x << ' ' << y << ' ' << z;
        }
        if (c < -96 || room < 0 || 25 * square_4 > 27 * (room + 4) * (room + 4)) {
          ASSERT_FALSE(cone.contains(x, y, z)) << x << ' ' << y << ' ' << z;
        }
      }
  EXPECT_EQ(missing, 0u);
  EXPECT_EQ(far, 0u);
  EXPECT_GT(ball, 600'000u);
}

TEST_F(SilhouettesCommand, BlocksHideEachOther) {
  draw_images();
  done({"build", "blocks.json", "-o", "blocks.octree"});
  // A point behind the window: seen through it from the front, hidden by the taller tower from the right.
  const Octree blocks = load(folder() / "blocks.octree").octree;
  EXPECT_FALSE(blocks.contains(30, 96, 80));  // in the window
  EXPECT_TRUE(blocks.contains(20, 96, 80));   // beside it
  EXPECT_TRUE(blocks.contains(100, 60, 50));  // the lower tower
  EXPECT_FALSE(blocks.contains(66, 40, 30));  // in the notch
  EXPECT_FALSE(blocks.contains(66, 90, 60));  // between the towers
}

TEST_F(SilhouettesCommand, DepthAndLikeTakeThePlaceOfTheFilesDepth) {
  draw_images();
  done({"build", "blocks.json", "-o", "b7.octree"});
  done({"build", "blocks.json", "-o", "b5.octree", "--depth", "5"});
  const auto info = [&](const std::string& name) { return done({"info", name, "--json"}).json(); };
  EXPECT_EQ(info("b5.octree")["bounding_box"], nlohmann::json::parse("[[4,4,4],[28,28,26]]"));
  EXPECT_EQ(info("b7.octree")["bounding_box"], nlohmann::json::parse("[[16,16,16],[112,112,104]]"));
  EXPECT_EQ(info("b7.octree")["frame"]["unit"], "voxel");
  EXPECT_EQ(info("b7.octree")["metadata"]["options"], nlohmann::json::parse(R"({"depth":7,"silhouettes":3})"));
  make_stl("box.stl", {5, 6, 7}, {8, 8, 8});
  done({"build", "box.stl", "-o", "v.octree", "--depth", "6"});
  done({"build", "blocks.json", "-o", "like.octree", "--like", "v.octree"});
  EXPECT_EQ(info("like.octree")["bounding_box"], nlohmann::json::parse("[[8,8,8],[56,56,52]]"));
  EXPECT_EQ(info("like.octree")["frame"], info("v.octree")["frame"]);
}

TEST_F(SilhouettesCommand, BadInputIsRefused) {
  draw_images();
  write("none.json", R"({"views": ["none.png"]})");
  refused({"build", "none.json", "-o", "x.octree"}, "none.json: views[0].image: ");
  write("up.json", R"({"views": [{"image": "cup1.png", "view": "top", "up": "bottom"}]})");
  refused({"build", "up.json", "-o", "x.octree"}, "up.json: views[0].up is parallel to the view");
  write("broken.toml", "views = [\n");
  refused({"build", "broken.toml", "-o", "x.octree"}, "broken.toml: is not TOML");
  refused({"build", "cup.json", "-o", "x.octree", "--fit", "0.5"}, "--fit does not apply to 'cup.json'");
  refused({"build", "cup.json", "-o", "x.octree", "--rule", "touched"}, "--rule does not apply");
  refused({"build", "cup.json", "-o", "x.octree", "--depth", "21"}, "--depth");
}

}  // namespace
}  // namespace blackleaf::test
