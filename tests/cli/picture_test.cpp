// blackleaf draw and export.
#include <cmath>

#include "cli/run_command.h"

namespace blackleaf::test {
namespace {

using nlohmann::json;

class Pictures : public CliTest {
 protected:
  Pictures() { make_box("b.octree", 4, {4, 4, 4}, {10, 10, 10}); }
};

TEST_F(Pictures, JsonHasTheNineEdgesThatACubeShows) {
  done({"draw", "b.octree", "--view", "3,-4,2", "-o", "b.json"});
  const json drawing = json::parse(read("b.json"));
  EXPECT_EQ(drawing["strokes"].size(), 9u);
  EXPECT_EQ(drawing["view"], json::parse("[3,-4,2]"));
  const json report = done({"draw", "b.octree", "--view", "3,-4,2", "-o", "b.json", "--json"}).json();
  EXPECT_EQ(report["strokes"], 9);
  // Three visible edges along each axis; an edge along unit a is seen with length sqrt(1 - (a.d)^2).
  const double expected = 3 * 6 * (std::sqrt(20.0 / 29) + std::sqrt(13.0 / 29) + std::sqrt(25.0 / 29));
  EXPECT_NEAR(report["length"].get<double>(), expected, 1e-9);
}

TEST_F(Pictures, StandardOutputTakesSvgAndJson) {
  const Result svg = done({"draw", "b.octree", "--view", "-1,0,0", "-o", "-", "--format", "svg"});
  EXPECT_NE(svg.out.find("<svg"), std::string::npos);
  const Result text = done({"draw", "b.octree", "--view=-1,0,0", "-o", "-", "--format", "json"});
  EXPECT_EQ(text.json()["strokes"].size(), 4u);
  refused({"draw", "b.octree", "--view", "1,0,0", "-o", "-"}, "--format svg");
  refused({"draw", "b.octree", "--view", "1,0,0", "-o", "-", "--format", "png"}, "svg, hpgl, dxf or json");
  refused({"draw", "b.octree", "--view", "1,0,0", "-o", "-", "--format", "json", "--json"}, "--json");
}

TEST_F(Pictures, EveryFormatBeginsAsItShould) {
  for (const auto& [name, magic] : std::vector<std::pair<std::string, std::string>>{{"p.svg", "<"},
                                                                                    {"p.png", "\x89PNG"},
                                                                                    {"p.pdf", "%PDF"},
                                                                                    {"p.json", "{"},
                                                                                    {"p.hpgl", "IN;"},
                                                                                    {"p.dxf", "0\nSECTION"}}) {
    const Result result = done({"draw", "b.octree", "--view", "1,2,3", "-o", name});
    EXPECT_EQ(read(name).substr(0, magic.size()), magic);
    EXPECT_NE(result.out.find(name + ": 9 strokes"), std::string::npos) << result.out;
  }
  EXPECT_EQ(files(), (std::vector<std::string>{"b.octree", "p.dxf", "p.hpgl", "p.json", "p.pdf", "p.png", "p.svg"}));
}

TEST_F(Pictures, PenOrderAndStats) {
  const auto stats = [&](const std::string& order) {
    return done({"draw", "b.octree", "--view", "3,-4,2", "-o", "p.svg", "--order", order, "--stats", "--json"})
        .json()["pen"];
  };
  const json none = stats("none");
  EXPECT_EQ(none["before"], none["after"]);
  for (const char* order : {"strokes", "chains"}) {
    const json pen = stats(order);
    EXPECT_EQ(pen["before"], none["before"]);
    EXPECT_EQ(pen["after"]["strokes"], 9);
    EXPECT_NEAR(pen["after"]["pen_down"].get<double>(), none["after"]["pen_down"].get<double>(), 1e-9);
    EXPECT_LE(pen["after"]["pen_up"].get<double>(), none["after"]["pen_up"].get<double>());
    // A cube shows 7 corners, three lines meet in 4 of them: two chains.
    EXPECT_EQ(pen["after"]["pen_lifts"], 2);
  }
  const Result text = done({"draw", "b.octree", "--view", "3,-4,2", "-o", "p.hpgl", "--stats", "--quiet"});
  EXPECT_NE(text.out.find("in order: 9 strokes, pen down"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("2 pen lifts"), std::string::npos);
  refused({"draw", "b.octree", "--view", "1,0,0", "-o", "q.svg", "--order", "best"}, "--order");
  refused({"draw", "b.octree", "--view", "1,0,0", "-o", "q.json", "--stats"}, "--stats");
  refused({"draw", "b.octree", "--view", "1,0,0", "-o", "q.hpgl", "--size", "2000x2000"}, "HP-GL reaches, 819.175 mm");
}

TEST_F(Pictures, Sheets) {
  make_box("flat.octree", 5, {2, 3, 4}, {22, 9, 12});
  for (const std::string angle : {"first", "third"}) {
    const json sheet =
        json::parse(done({"draw", "flat.octree", "--sheet", "--angle", angle, "-o", "-", "--format", "json"}).out);
    EXPECT_EQ(sheet["page"], json::parse("[297,210]"));
    ASSERT_EQ(sheet["views"].size(), 4u);
    EXPECT_EQ(sheet["views"][0]["view"], json::parse("[0,-1,0]"));
    EXPECT_EQ(sheet["views"][2]["name"], angle == "first" ? "left" : "right");
    EXPECT_EQ(sheet["views"][3]["view"], json::parse("[1,-1,1]"));
    EXPECT_EQ(sheet["source"], "flat.octree");
    // A box shows four edges from each side and nine from a corner.
    EXPECT_EQ(sheet["layers"][0]["name"], "visible");
    EXPECT_EQ(sheet["layers"][0]["strokes"].size(), 3u * 4 + 9);
  }
  const std::string svg =
      done({"draw", "flat.octree", "--sheet", "--scale", "2:1", "--size", "a3", "-o", "-", "--format", "svg"}).out;
  EXPECT_NE(svg.find("width=\"420mm\" height=\"297mm\""), std::string::npos);
  EXPECT_NE(svg.find("millimetres-per-voxel=\"2\""), std::string::npos);
  EXPECT_NE(svg.find("inkscape:label=\"title block\""), std::string::npos);
  for (const char* name : {"s.svg", "s.pdf", "s.png", "s.hpgl", "s.dxf"})
    done({"draw", "flat.octree", "--sheet", "--title", "a box", "--date", "2026-11-22", "-o", name, "--stats"});
  const std::vector<std::string> sheet{"draw", "flat.octree", "--sheet", "-o", "t.svg"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), sheet.begin(), sheet.end());
    return more;
  };
  refused(with({"--view", "1,2,3"}), "--view");
  refused(with({"--angle", "second"}), "--angle");
  refused(with({"--scale", "2"}), "--scale");
  refused(with({"--scale", "0:1"}), "--scale");
  refused(with({"--scale", "1:nan"}), "--scale");
  refused(with({"--scale", "100:1"}), "use a larger page or 5:1");
  refused(with({"--size", "A6"}), "too small for a sheet");
  refused({"draw", "flat.octree", "--view", "1,2,3", "--angle", "first", "-o", "t.svg"}, "--angle belongs to --sheet");
  refused({"draw", "flat.octree", "--view", "1,2,3", "--scale", "1:1", "-o", "t.svg"}, "--scale belongs to --sheet");
}

TEST_F(Pictures, Pens) {
  const auto svg = [&](const std::string& pen) {
    return done({"draw", "b.octree", "--view", "1,2,3", "--pen", pen, "-o", "-", "--format", "svg"}).out;
  };
  EXPECT_NE(svg("#0a1").find("stroke=\"#00aa11\""), std::string::npos);
  EXPECT_NE(svg("#12AB3c").find("stroke=\"#12ab3c\""), std::string::npos);
  EXPECT_NE(
      svg("red:0.7").find("stroke=\"#d55e00\" stroke-linecap=\"round\" stroke-linejoin=\"round\" stroke-width=\"0.7\""),
      std::string::npos);
  for (const char* pen : {"", "pink", "#12", "#12345g", "red:", "red:0", "red:-1", ":1", "red:1:2"})
    refused({"draw", "b.octree", "--view", "1,2,3", "--pen", pen, "-o", "p.svg"}, "--pen");
  refused({"draw", "b.octree", "--view", "1,2,3", "--pen", "red", "--pen", "blue", "-o", "p.svg"}, "--pen");
  refused({"draw", "b.octree", "--view", "1,2,3", "--pen", "red", "-o", "p.json"}, "JSON");
}

TEST_F(Pictures, NothingToSee) {
  make_box("empty.octree", 3, {0, 0, 0}, {0, 0, 0});
  for (const char* name : {"e.svg", "e.pdf", "e.png", "e.hpgl", "e.dxf", "e.json"}) {
    const Result result = run({"draw", "empty.octree", "--view", "1,2,3", "-o", name});
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(lines(result.err), 1u) << result.err;
    EXPECT_NE(result.err.find("the picture is empty"), std::string::npos) << result.err;
    EXPECT_FALSE(read(name).empty());
  }
  EXPECT_EQ(json::parse(read("e.json"))["strokes"], json::array());
}

TEST_F(Pictures, PageSizes) {
  // Seen from the front a cube is square: the page stands; a flat box makes it lie down.
  make_box("flat.octree", 4, {0, 4, 4}, {16, 10, 6});
  const auto svg = [&](const std::string& file, const std::string& size) {
    return done({"draw", file, "--view", "0,-1,0", "-o", "-", "--format", "svg", "--size", size, "--pen-width", "0.5"})
        .out;
  };
  EXPECT_NE(svg("b.octree", "A4").find("width=\"210mm\" height=\"297mm\""), std::string::npos);
  EXPECT_NE(svg("flat.octree", "a4").find("width=\"297mm\" height=\"210mm\""), std::string::npos);
  EXPECT_NE(svg("flat.octree", "A6").find("width=\"148mm\" height=\"105mm\""), std::string::npos);
  EXPECT_NE(svg("flat.octree", "100x150").find("width=\"100mm\" height=\"150mm\""), std::string::npos);
  for (const char* size : {"A9", "B4", "100", "100x", "0x10", "-5x10", "nanx10", "1x2x3", "1e9x1e9", "5x5"})
    refused({"draw", "b.octree", "--view", "1,0,0", "-o", "p.svg", "--size", size}, "");
  refused({"draw", "b.octree", "--view", "1,0,0", "-o", "p.svg", "--pen-width", "0"}, "--pen-width");
  refused({"draw", "b.octree", "--view", "1,0,0", "-o", "p.json", "--size", "A4"}, "--size");
}

TEST_F(Pictures, DrawRefusals) {
  for (const char* view : {"0,0,0", "nan,0,1", "1,2", "1,2,3,4", "inf,0,0", "1;2;3", "a,b,c", "1, 2,3", ""})
    refused({"draw", "b.octree", "--view", view, "-o", "p.svg"}, "--view");
  refused({"draw", "b.octree", "-o", "p.svg"}, "--view");
  refused({"draw", "b.octree", "--view", "1,0,0", "-o", "p.gif"}, ".svg, .pdf, .png, .hpgl, .dxf or .json");
  refused({"draw", "b.octree", "--view", "1,0,0", "-o", "p.svg", "--format", "pdf"}, "--format pdf");
}

TEST_F(Pictures, ExportedVolumesComeBackTheSame) {
  const std::string runs = done({"export", "b.octree", "-o", "-"}).out;
  for (const char* name : {"v.nrrd", "v.nii", "v.nii.gz", "v.mha"}) {
    SCOPED_TRACE(name);
    done({"export", "b.octree", "-o", name});
    done({"build", name, "-o", "back.octree"});
    EXPECT_EQ(done({"export", "back.octree", "-o", "-"}).out, runs);
    done({"export", "b.octree", "-o", name, "--crop"});
    done({"build", name, "-o", "back.octree"});
    EXPECT_EQ(done({"info", "back.octree", "--json"}).json()["bounding_box"], json::parse("[[0,0,0],[6,6,6]]"));
    EXPECT_EQ(done({"info", "back.octree", "--json"}).json()["depth"], 3);
  }
}

TEST_F(Pictures, ExportedMeshesAreClosedAndComeBackTheSame) {
  const std::string runs = done({"export", "b.octree", "-o", "-"}).out;
  for (const char* name : {"m.stl", "m.obj", "m.ply"}) {
    SCOPED_TRACE(name);
    const json report = done({"export", "b.octree", "-o", name, "--json"}).json();
    EXPECT_EQ(report["triangles"], 2 * 6 * 36);
    EXPECT_EQ(report["file_bytes"], std::filesystem::file_size(folder() / name));
    done({"build", name, "-o", "back.octree", "--like", "b.octree"});
    EXPECT_EQ(done({"export", "back.octree", "-o", "-"}).out, runs);
  }
  done({"export", "b.octree", "-o", "b.runs"});
  EXPECT_EQ(read("b.runs"), runs);
}

TEST_F(Pictures, ExportRefusals) {
  refused({"export", "b.octree", "-o", "b.xyz"}, "unknown suffix '.xyz'");
  refused({"export", "b.octree", "-o", "b"}, "unknown suffix");
  refused({"export", "b.octree", "-o", "b.stl", "--crop"}, "--crop");
  refused({"export", "b.octree", "-o", "-", "--json"}, "--json");
  make_box("deep.octree", 12, {0, 0, 0}, {1, 1, 1});
  refused({"export", "deep.octree", "-o", "deep.nrrd"}, "");
  done({"export", "deep.octree", "-o", "deep.nrrd", "--crop"});
}

}  // namespace
}  // namespace blackleaf::test
