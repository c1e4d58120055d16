// blackleaf reproduce: the page of the papers' tables and figures, and the files beside it.
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <sstream>

#include "blackleaf/measures.h"
#include "blackleaf/octree_file.h"
#include "cli/run_command.h"

namespace blackleaf::test {
namespace {

class ReproduceCommand : public CliTest {
 protected:
  static std::size_t count(const std::string& text, const std::string& part) {
    std::size_t number = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++number;
    return number;
  }
  // The octree of the silhouettes that the command has written for one of VA88's objects.
  Octree built(const std::string& name) const {
    done({"build", "papers/va88-" + name + ".json", "--depth", "7", "-o", name + ".octree"});
    return load(folder() / (name + ".octree")).octree;
  }

  // MHF92's Figure 1: from node to node the curve goes one step, and it meets every point.
  void curves_are_continuous() const {
    std::istringstream table(read("papers/mhf92-figure-1.csv"));
    std::string line;
    std::getline(table, line);
    EXPECT_EQ(line, "order,node,x,y,z");
    for (const int order : {0, 1, 2}) {
      const int side = 1 << order;
      std::vector<bool> met(static_cast<std::size_t>(side * side * side));
      std::array<int, 3> before{};
      for (int node = 0; node < side * side * side; ++node) {
        ASSERT_TRUE(std::getline(table, line));
        std::array<int, 5> values{};
        std::istringstream fields(line);
        for (int& value : values) {
          fields >> value;
          fields.ignore();
        }
        ASSERT_EQ(values[0], order);
        ASSERT_EQ(values[1], node);
        const std::array<int, 3> at = {values[2], values[3], values[4]};
        int steps = 0;
        for (std::size_t i = 0; i < 3; ++i) {
          ASSERT_TRUE(at[i] >= 0 && at[i] < side);
          steps += std::abs(at[i] - before[i]);
        }
        EXPECT_EQ(steps, node == 0 ? 0 : 1) << line;
        const auto place = static_cast<std::size_t>(at[0] + side * (at[1] + side * at[2]));
        EXPECT_FALSE(met[place]) << line;
        met[place] = true;
        before = at;
        if (order == 2 && node == 30) {
          EXPECT_EQ(line, "2,30,0,1,3");  // the paper's example
        }
      }
    }
    EXPECT_FALSE(std::getline(table, line));
    // 0, 7 and 63 links, each with a white band below it.
    EXPECT_EQ(count(read("papers/mhf92-figure-1.svg"), "<line "), 2u * (7 + 63));
  }

  // VA88's objects have the volumes of the solids that they are named after. Surfaces are a voxel off at most.
  void silhouettes_give_solids() const {
    using std::numbers::pi;
    const auto expect = [&](const std::string& name, double volume, double most_more) {
      const Octree octree = built(name);
      EXPECT_EQ(octree.depth(), 7);
      const Measures measures = measure(octree);
      // Half a voxel of surface either way: unit faces are at most sqrt(3) times as many as the surface is large.
      const double rounding = 0.5 * static_cast<double>(measures.surface_area);
      EXPECT_GT(static_cast<double>(measures.volume), volume - rounding) << name;
      EXPECT_LT(static_cast<double>(measures.volume), volume * most_more + rounding) << name;
      // ... and rounding evens out.
      EXPECT_NEAR(static_cast<double>(measures.volume), volume * (1 + most_more) / 2, 0.03 * volume) << name;
    };
    expect("cylinder", pi * 40 * 40 * 96, 1);
    // Eight views round it off to a polygon of sixteen sides.
    expect("cone", pi * 48 * 48 * 96 / 3, 16 / pi * std::tan(pi / 16));
    expect("sphere", 4 * pi * 56 * 56 * 56 / 3, 1.004);
    expect("pyramid", 96.0 * 96 * 96 / 3, 1);
    expect("diamond", 2.0 * 56 * 56 * 56, 1);  // a rhombic dodecahedron
  }

  // The same pixels as those of the script in examples/va88, which wrote them down apart from the program.
  void silhouettes_are_the_examples() const {
    const std::string command = "python3 '" BLACKLEAF_EXAMPLES "/va88/make_silhouettes.py' '" + folder().string() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);  // NOLINT(cert-env33-c,concurrency-mt-unsafe): a test's own folder
    for (const char* name : {"cylinder", "cone", "sphere", "pyramid", "cup", "blocks", "diamond"}) {
      const Octree ours = built(name);
      const std::string example = std::string(name) + (std::string(name) == "sphere" ? ".toml" : ".json");
      done({"build", example, "-o", "example.octree"});
      EXPECT_TRUE(load(folder() / "example.octree").octree == ours) << name;
    }
  }
};

TEST_F(ReproduceCommand, WritesThePapersTablesAndFigures) {
  const nlohmann::json report = done({"reproduce", "-o", "papers", "--json"}).json();
  const std::vector<std::string> names = report["files"];
  EXPECT_EQ(names.size(), 52u);
  EXPECT_EQ(names.back(), "index.html");
  const std::string page = read("papers/index.html");
  for (const std::string& name : names) {
    const std::string content = read("papers/" + name);
    ASSERT_FALSE(content.empty()) << name;
    if (name.ends_with(".png")) {
      EXPECT_EQ(content.substr(0, 8), "\x89PNG\r\n\x1a\n") << name;
    }
    if (name.ends_with(".svg") || name == "index.html") {
      EXPECT_EQ(count(content, "<svg "), count(content, "</svg>")) << name;
      EXPECT_EQ(count(content, "<g ") + count(content, "<g>"), count(content, "</g>")) << name;
      EXPECT_EQ(count(content, "nan"), 0u) << name;
      EXPECT_GE(count(content, "<svg "), 1u) << name;
    }
  }
  for (const char* id : {"an84-figure-2", "an84-figure-3", "an84-figure-4", "wa87-table-1", "wa87-table-2",
                         "mhf92-figure-1", "va88-figure-5", "va88-figure-6", "va88-figure-7", "va88-figure-8",
                         "va88-figure-9", "va88-figure-10", "va88-figure-11", "va88-figure-12"}) {
    EXPECT_NE(page.find(std::string("<section id=\"") + id), std::string::npos) << id;
    EXPECT_NE(page.find(std::string("href=\"#") + id + "\""), std::string::npos) << id;
  }
  EXPECT_EQ(page.find("src="), std::string::npos) << "the page needs no other file";

  // WA87's Table 1, as printed and as computed.
  EXPECT_NE(read("papers/wa87-table-1-bounds.csv").find("\n8,0.092,0.09176,0.0228,0.022798,0.022801,0.186,0.18598"),
            std::string::npos)
      << read("papers/wa87-table-1-bounds.csv");
  // One voxel about the universe's middle may be eight: the bound is reached, at 8 n - 7 internal nodes for n = 2.
  const std::string measured = read("papers/wa87-table-1-measured.csv");
  EXPECT_NE(measured.find("\n0,400,8,1278,1 %,9,9,100 %"), std::string::npos) << measured;
  for (std::size_t at = measured.find(" %"); at != std::string::npos; at = measured.find(" %", at + 1)) {
    const std::size_t begin = measured.rfind(',', at) + 1;
    EXPECT_LE(std::stoi(measured.substr(begin, at - begin)), 100);
  }
  // Table 2: every number of object (a) that can be read.
  const std::string table = read("papers/wa87-table-2a.csv");
  for (const char* row :
       {"\n4,96,source,12,12,7,7,–,–,–,0.073,0.073,as printed", "\n4,96,\"(0,1,0), -30°, (8,0,0)\",47,47,–,",
        "\n6,6144,\"(0,1,0), -30°, (8,0,0)\",739,739,–,", "\n6,6144,\"(1,1,1), 30°, (2,2,0)\",2042,2042,673,673,676,",
        "\n7,49152,\"(1,1,1), 30°, (2,2,0)\",–,", "2713,2713,2718,"})
    EXPECT_NE(table.find(row), std::string::npos) << row << "\n" << table;
  EXPECT_EQ(table.find("another object"), std::string::npos);
  // Figure 4: four leaves become two of side 4 and sixteen of side 2.
  const std::string moved = read("papers/an84-figure-4b.txt");
  const auto black = [](const std::string& text) {
    std::size_t count = 0;
    for (std::size_t at = text.find("black"); at != std::string::npos; at = text.find("black", at + 1)) ++count;
    return count;
  };
  EXPECT_EQ(black(read("papers/an84-figure-4a.txt")), 4u);
  EXPECT_EQ(black(moved), 18u);
  // Figure 3: the sums of the paper.
  EXPECT_EQ(read("papers/an84-figure-3.txt"), "r057\nr075\nr275\n");
  // Figure 2: a circle a node.
  const std::string tree = read("papers/an84-figure-2.svg");
  EXPECT_EQ(count(tree, "<circle "), 1 + 8 + 2 * 8u);
  EXPECT_EQ(count(tree, "fill=\"lightgray\""), 3u);

  // Once more, over what is there: only what is measured differs.
  std::vector<std::string> once;
  for (const std::string& name : names) once.push_back(read("papers/" + name));
  EXPECT_EQ(done({"reproduce", "-o", "papers"}).out,
            "papers: " + std::to_string(names.size()) + " files; open papers/index.html\n");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool timed = names[i] == "index.html" || names[i].starts_with("va88-figure-12");
    EXPECT_TRUE(timed || read("papers/" + names[i]) == once[i]) << names[i];
  }
}

TEST_F(ReproduceCommand, FiguresAreOfWhatTheySay) {
  done({"reproduce", "-o", "papers"});
  curves_are_continuous();
  silhouettes_give_solids();
  silhouettes_are_the_examples();
}

TEST_F(ReproduceCommand, Refuses) {
  write("file", "");
  refused({"reproduce"}, "--output is required");
  refused({"reproduce", "-o", ""}, "the folder's name is empty");
}

}  // namespace
}  // namespace blackleaf::test
