#include "blackleaf/points_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "blackleaf/error.h"
#include "file/temporary_folder.h"
#include "io/lzf.h"

namespace blackleaf::test {
namespace {

using Points = std::vector<Eigen::Vector3d>;
using Bytes = std::vector<std::uint8_t>;

class PointsFile : public ::testing::Test {
 protected:
  Points read(const std::string& name, PointsInfo* told = nullptr) const {
    Points points;
    const PointsInfo info = read_points(folder_ / name, [&](std::span<const Eigen::Vector3d> piece) {
      EXPECT_FALSE(piece.empty());
      points.insert(points.end(), piece.begin(), piece.end());
    });
    EXPECT_EQ(info.points, points.size());
    if (told) *told = info;
    return points;
  }
  Points read(const std::string& name, const std::string& content) const {
    write_file(folder_ / name, content);
    return read(name);
  }
  void refused(const std::string& name, const std::string& content, const std::vector<std::string>& pieces) const {
    write_file(folder_ / name, content);
    std::vector<std::string> all = pieces;
    all.push_back(name + ": ");
    expect_error(ErrorCode::bad_input, all, [&] { read(name); });
  }

  TemporaryFolder folder_;
};

std::string raw(double value, const std::string& type, bool big) {
  const auto as = [&](auto number) {
    std::string bytes(sizeof number, '\0');
    std::memcpy(bytes.data(), &number, sizeof number);
    if (big != (std::endian::native == std::endian::big)) std::reverse(bytes.begin(), bytes.end());
    return bytes;
  };
  if (type == "char" || type == "int8") return as(static_cast<std::int8_t>(value));
  if (type == "uchar" || type == "uint8") return as(static_cast<std::uint8_t>(value));
  if (type == "short" || type == "int16") return as(static_cast<std::int16_t>(value));
  if (type == "ushort" || type == "uint16") return as(static_cast<std::uint16_t>(value));
  if (type == "int" || type == "int32") return as(static_cast<std::int32_t>(value));
  if (type == "uint" || type == "uint32") return as(static_cast<std::uint32_t>(value));
  if (type == "float" || type == "float32") return as(static_cast<float>(value));
  return as(value);
}

const std::vector<std::string> kTypes = {"char", "int8",  "uchar", "uint8",  "short", "int16",   "ushort", "uint16",
                                         "int",  "int32", "uint",  "uint32", "float", "float32", "double", "float64"};

// ---- text

const Points kThree = {{1, 2, 3}, {-4, 5e-1, 6}, {7, 8, -900}};

TEST_F(PointsFile, TextInAllItsShapes) {
  EXPECT_EQ(read("a.xyz", "1 2 3\n-4 .5 6\n7 8 -9e2\n"), kThree);
  EXPECT_EQ(read("b.txt", "1 2 3\r\n-4 0.5 6\r\n7 8 -9E+2"), kThree);        // no end of line at the end
  EXPECT_EQ(read("c.asc", "\r1\t2  3\r -4 +.5 6\r\r7 8 -900.0\r"), kThree);  // old ends of lines
  EXPECT_EQ(read("d.xyz", "# one\n\n1 2 3 # here\n// two\n-4 0.5 6 7 8 9\n7 8 -900 x"), kThree);
  EXPECT_EQ(read("e.csv", "1,2,3\n-4 , 0.5,6\n7,8,-900,\"red\"\n"), kThree);
  EXPECT_EQ(read("f.csv", "1;2;3\n-4; 0.5 ;6\n7;8;-900\n"), kThree);
  EXPECT_EQ(read("g.csv", "id,\"X\",intensity,'z',y\n9,1,0,3,2\n9,-4,0,6,.5\n9,7,0,-900,8\n"), kThree);
  EXPECT_EQ(read("h.pts", "3\n1 2 3 10 255 0 0\n-4 .5 6 10 0 0 0\n7 8 -900 1 1 1 1\n"), kThree);
  EXPECT_EQ(read("i.pts", "2\n1 2 3\n-4 .5 6\n1\n7 8 -900\n"), kThree);  // two scans
  EXPECT_EQ(read("j.xyz",
                 "\xEF\xBB\xBF"
                 "1 2 3\n-4 .5 6\n7 8 -900\n"),
            kThree);                                                        // a byte order mark
  EXPECT_EQ(read("k.XYZ", "//X Y Z\n1 2 3\n-4 .5 6\n7 8 -900\n"), kThree);  // CloudCompare
}

TEST_F(PointsFile, TextThatIsNoPointsIsRefused) {
  refused("a.xyz", "1 2 3\n1 2\n", {"line 2 is \"1 2\", which has no z"});
  refused("b.xyz", "1 2 3\r\n\r\n# x\r\n1 two 3\r\n", {"line 4", "has no y"});
  refused("c.xyz", "2\nwater\nO 0 0 0\nH 1 0 0\n", {"line 2 is \"water\""});  // molecules
  refused("d.xyz", "1,5 2,5 3,5\n", {"line 1", "no y"});                      // commas for decimal points
  refused("e.xyz", "1,5; 2,5; 3,5\n", {"line 1", "no x"});
  refused("f.csv", "a,b,c\n1,2,3\n", {"line 1 is \"a,b,c\""});
  refused("g.xyz", "# nothing\n\n", {"has no points"});
  refused("h.csv", "x,y,z\n", {"has no points"});
  refused("i.pts", "3\n1 2 3\n", {"tells of 3 points but has 1"});
  refused("j.pts", "1\n1 2 3\n4 5 6\n", {"tells of 1 points but has 2"});
  refused("k.pts", "4000000000\n1 2 3\n", {"tells of 4000000000 points but there are 6 bytes"});
  refused("l.pts", "2\n1 2 3\n1\n4 5 6\n", {"line 3 tells of 1 more points, after 1 instead of 2"});
  refused("m.xyz", "1 2 3\n5\n", {"line 2"});
  refused("n.txt", std::string("\0\1\2\3\4\5 garbage\n", 16), {"line 1"});
  write_file(folder_ / "o.xyz", "");
  expect_error(ErrorCode::bad_input, {"o.xyz: is empty"}, [&] { read("o.xyz"); });
  expect_error(ErrorCode::io, {"no such file"}, [&] { read("none.pcd"); });
  EXPECT_EQ(read("long.xyz", "1 2 3 " + std::string(100'000, '7') + "\n4 5 6\n").size(), 2u);
}

TEST_F(PointsFile, NumbersBeyondTheDoublesAndNoNumbersAreCounted) {
  write_file(folder_ / "a.xyz", "1 2 3\nnan 1 1\n1e999 0 0\n0 -inf 0\n1e-999 5 5\n");
  PointsInfo info;
  const Points points = read("a.xyz", &info);
  EXPECT_EQ(points.size(), 5u);
  EXPECT_EQ(info.not_finite, 3u);
  EXPECT_EQ(info.box.min(), Eigen::Vector3d(0, 2, 3));
  EXPECT_EQ(info.box.max(), Eigen::Vector3d(1, 5, 5));
}

// ---- PLY

TEST_F(PointsFile, PlyOfEveryTypeAndByteOrder) {
  for (const std::string& type : kTypes)
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
      SCOPED_TRACE(type + " " + format);
      const bool text = std::string(format) == "ascii", big = std::string(format) == "binary_big_endian";
      const bool sign = type[0] != 'u';
      // Something of every type in front of, between and behind the coordinates, and an element before the vertices.
      std::string head = fmt::format(
          "ply\nformat {} 1.0\ncomment element vertex 99\nelement camera 2\nproperty list uchar short rows\n"
          "element vertex 3\nproperty uchar red\nproperty {} y\nproperty list ushort double more\nproperty {} x\n"
          "property {} z\nproperty int last\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n",
          format, type, type, type);
      std::string body;
      const auto put = [&](double value, const std::string& as) {
        if (text) {
          body += fmt::format("{} ", value);
        } else {
          body += raw(value, as, big);
        }
      };
      for (int camera = 0; camera < 2; ++camera) {
        put(camera, "uchar");
        for (int i = 0; i < camera; ++i) put(-7, "short");
        if (text) body += "\n";
      }
      Points expected;
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d p(i * 20, sign ? -i : i, 100 + i);
        expected.push_back(p);
        put(255, "uchar");
        put(p.y(), type);
        put(i, "ushort");
        for (int k = 0; k < i; ++k) put(0.1, "double");
        put(p.x(), type);
        put(p.z(), type);
        put(-1, "int");
        if (text) body += "\n";
      }
      EXPECT_EQ(read("p.ply", head + body), expected);
      EXPECT_TRUE(is_point_cloud(folder_ / "p.ply"));
    }
}

TEST_F(PointsFile, PlyWithRowsOfOneLength) {
  std::mt19937 random(8);
  std::string body;
  Points expected;
  for (int i = 0; i < 70'000; ++i) {  // more than one piece
    const Eigen::Vector3d p(std::uniform_real_distribution(-9.0, 9.0)(random), i * -1e9, i);
    expected.push_back(p);
    body += raw(i, "int", true) + raw(p.x(), "double", true) + raw(p.y(), "double", true) + raw(i, "uint", true);
  }
  const std::string head =
      "ply\r\nformat binary_big_endian 1.0\r\nelement vertex 70000\r\nproperty int a\r\nproperty double x\r\n"
      "property double y\r\nproperty uint z\r\nend_header\r\n";
  EXPECT_EQ(read("p.ply", head + body), expected);
  for (std::size_t cut : {std::size_t{0}, std::size_t{1}, std::size_t{24}, body.size() / 2, body.size() - 1})
    refused("p.ply", head + body.substr(0, cut), {"70000 of \"vertex\"", fmt::format("there are {}", cut / 24)});
  EXPECT_EQ(read("p.ply", head + body + std::string(23, '\0')), expected) << "padding";
  refused("p.ply", head + body + std::string(24, '\0'), {"70000 of \"vertex\" but there are 24 bytes behind them"});
  refused("p.ply", head + body + body, {"mend the numbers in its header"});
}

TEST_F(PointsFile, PlyThatLiesIsRefused) {
  const auto head = [](const std::string& format, const std::string& rest) {
    return "ply\nformat " + format + " 1.0\n" + rest + "end_header\n";
  };
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  refused("a.ply", "no ply\n", {"does not begin with \"ply\""});
  refused("a.ply", "ply\nformat ascii 1.0\n", {"no end_header"});
  refused("a.ply", head("ascii", "element vertex 2\n" + xyz) + "1 2 3\n", {"2 of \"vertex\" but there are 1"});
  refused("a.ply", head("ascii", "element vertex 1\n" + xyz) + "1 2\n", {"vertex 0 has no good \"z\""});
  refused("a.ply", head("ascii", "element vertex 1\n" + xyz) + "1 b 3\n", {"vertex 0 has no good \"y\""});
  refused("a.ply", head("ascii", "element vertex 1\nproperty list uchar int l\n" + xyz) + "3 1 2\n",
          {"vertex 0 has no good \"l\""});
  refused("a.ply", head("ascii", "element vertex 0\n" + xyz), {"has no vertices"});
  refused("a.ply", head("ascii", "element face 1\nproperty list uchar int l\n") + "0\n", {"has no vertices"});
  refused("a.ply", head("ascii", "element vertex 1\nproperty float x\nproperty float y\n") + "1 2\n", {"have no z"});
  refused("a.ply", head("ascii", "element vertex 1\nproperty list uchar float x\n") + "1 2\n", {"its x is a list"});
  refused("a.ply", head("ascii", "element vertex 1\nproperty quad x\n") + "1 2\n", {"unknown type"});
  refused("a.ply", head("binary", "element vertex 1\n" + xyz) + "1 2 3\n", {"format is \"binary\""});
  for (const char* count : {"18446744073709551615", "1537228672809129302", "4000000000"})
    refused("a.ply", head("binary_little_endian", std::string("element vertex ") + count + "\n" + xyz) + "123456789012",
            {"but there are 1"});
  refused("a.ply",
          head("binary_little_endian", "element vertex 1\nproperty list uint double l\n" + xyz) + "\xFF\xFF\xFF\xFF",
          {"1 of \"vertex\""});
  refused(
      "a.ply",
      head("binary_little_endian", "element vertex 1\nproperty list char double l\n" + xyz) + std::string(20, '\xFF'),
      {"list of -1 numbers"});
}

TEST_F(PointsFile, WhatIsAPointCloud) {
  const auto ply = [&](const std::string& more) {
    write_file(folder_ / "p.ply",
               "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n" + more + "end_header\n1\n");
    return is_point_cloud(folder_ / "p.ply");
  };
  EXPECT_TRUE(ply(""));
  EXPECT_TRUE(ply("element face 0\nproperty list uchar int i\n"));
  EXPECT_FALSE(ply("element face 1\nproperty list uchar int i\n"));
  EXPECT_FALSE(ply("element tristrips 1\nproperty list uchar int i\n"));
  for (const char* name : {"a.pcd", "a.XYZ", "a.pts", "a.asc", "a.txt", "a.csv", "a.xyzrgb"})
    EXPECT_TRUE(is_point_cloud(name)) << name;  // there need be no such file
  for (const char* name : {"a.stl", "a.nrrd", "a", "xyz", "a.json"}) EXPECT_FALSE(is_point_cloud(name)) << name;
}

TEST_F(PointsFile, VerticesOfAMeshAreTaken) {
  write_file(folder_ / "t.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n");
  const Points points = read("t.off");
  ASSERT_EQ(points.size(), 3u);
  EXPECT_NE(std::find(points.begin(), points.end(), Eigen::Vector3d(0, 2, 0)), points.end());
}

// ---- PCD

std::string pcd_head(int points, const std::string& data) {
  return fmt::format(
      "# .PCD v0.7\nVERSION 0.7\nFIELDS intensity z y normal x\nSIZE 2 8 4 4 4\nTYPE U F F F I\nCOUNT 1 1 1 3 1\n"
      "WIDTH {}\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA {}\n",
      points / 2, points, data);
}

// LZF as its author's library packs: literal runs, and references to what has been seen in the last 8 KiB.
std::string lzf_pack(const std::string& data) {
  std::string packed, literal;
  const auto flush = [&] {
    for (std::size_t at = 0; at < literal.size(); at += 32) {
      const std::string run = literal.substr(at, 32);
      packed += static_cast<char>(run.size() - 1);
      packed += run;
    }
    literal.clear();
  };
  for (std::size_t at = 0; at < data.size();) {
    std::size_t best = 0, distance = 0;
    for (std::size_t back = 1; back <= std::min<std::size_t>(at, 300); ++back) {
      std::size_t length = 0;
      while (length < 264 && at + length < data.size() && data[at + length] == data[at + length - back]) ++length;
      if (length > best) best = length, distance = back - 1;
    }
    if (best < 3) {
      literal += data[at++];
      continue;
    }
    flush();
    const std::size_t length = best - 2;
    if (length < 7) {
      packed += static_cast<char>(length << 5 | distance >> 8);
    } else {
      packed += static_cast<char>(7 << 5 | distance >> 8);
      packed += static_cast<char>(length - 7);
    }
    packed += static_cast<char>(distance & 0xFF);
    at += best;
  }
  flush();
  return packed;
}

TEST_F(PointsFile, PcdInItsThreeForms) {
  constexpr int kPoints = 500;
  Points expected;
  std::string text, rows;
  std::array<std::string, 5> columns;
  for (int i = 0; i < kPoints; ++i) {
    const Eigen::Vector3d p(-i, i % 3 == 0 ? std::numeric_limits<double>::quiet_NaN() : i * 0.25, i / 3.0);
    expected.push_back(p);
    const std::array<std::string, 5> fields = {
        raw(i, "ushort", false), raw(p.z(), "double", false), raw(p.y(), "float", false),
        raw(0, "float", false) + raw(0, "float", false) + raw(1, "float", false), raw(p.x(), "int", false)};
    for (std::size_t k = 0; k < 5; ++k) {
      rows += fields[k];
      columns[k] += fields[k];
    }
    text += fmt::format("{} {} {} 0 0 1 {}\n", i, p.z(), p.y(), p.x());
  }
  const std::string unpacked = columns[0] + columns[1] + columns[2] + columns[3] + columns[4];
  const std::string packed = lzf_pack(unpacked);
  ASSERT_LT(packed.size(), unpacked.size() / 2);
  const auto compressed = [&](double packed_size, double unpacked_size) {
    return pcd_head(kPoints, "binary_compressed") + raw(packed_size, "uint", false) +
           raw(unpacked_size, "uint", false) + packed;
  };
  const auto packed_size = static_cast<double>(packed.size()), unpacked_size = static_cast<double>(unpacked.size());
  const auto check = [&](const std::string& content) {
    const Points points = read("p.pcd", content);
    ASSERT_EQ(points.size(), expected.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      for (int k = 0; k < 3; ++k)
        ASSERT_TRUE(points[i][k] == expected[i][k] || (std::isnan(points[i][k]) && std::isnan(expected[i][k]))) << i;
  };
  check(pcd_head(kPoints, "ascii") + text);
  check(pcd_head(kPoints, "binary") + rows);
  check(compressed(packed_size, unpacked_size));
  PointsInfo info;
  read("p.pcd", &info);
  EXPECT_EQ(info.not_finite, 167u);

  refused("p.pcd", pcd_head(kPoints, "ascii") + text.substr(0, text.find('\n', text.size() / 2) + 1),
          {"tells of 500 points but there are"});
  refused("p.pcd", pcd_head(kPoints, "ascii") + text + "1 2 3 4 5 6 7\n", {"there are more"});
  refused("p.pcd", pcd_head(2, "ascii") + "1 2 3 4 5 6\n", {"point 0 has 6 numbers instead of 7"});
  refused("p.pcd", pcd_head(2, "ascii") + "1 2 3 4 5 6 a\n", {"point 0 has \"a\" for its x"});
  refused("p.pcd", pcd_head(kPoints, "binary") + rows.substr(1), {"tells of 500 points but there are 499"});
  refused("p.pcd", pcd_head(kPoints, "zip") + rows, {"DATA are \"zip\""});
  refused("p.pcd", pcd_head(kPoints, "binary_compressed") + "1234567", {"there are 0"});
  refused("p.pcd", compressed(packed_size + 1, unpacked_size), {"compressed bytes but there are"});
  refused("p.pcd", compressed(packed_size - 1, unpacked_size), {"cannot be unpacked"});
  refused("p.pcd", compressed(packed_size, unpacked_size + 1), {"tells of 500 points of 30 bytes, but of 15001"});
  refused("p.pcd", compressed(20, unpacked_size), {"20 bytes cannot hold"});
  // Padding does no harm, what could be another point does.
  for (const std::string& whole : {pcd_head(kPoints, "binary") + rows, compressed(packed_size, unpacked_size)}) {
    check(whole + std::string(29, '\0'));
    refused("p.pcd", whole + std::string(30, '\0'), {"tells of 500 points but there are 30 bytes behind them"});
  }
}

TEST_F(PointsFile, PcdHeadersThatLieAreRefused) {
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string head = pcd_head(2, "binary");
    head.replace(head.find(from), from.size(), to);
    return head + std::string(60, '\0');
  };
  EXPECT_EQ(read("p.pcd", with("# .PCD", "# .PCD")).size(), 2u);
  EXPECT_EQ(read("p.pcd", with("POINTS 2\n", "")).size(), 2u);
  refused("p.pcd", with("WIDTH 1", "WIDTH 3"), {"2 points, but of 3 x 2"});
  refused("p.pcd", with("WIDTH 1", "WIDTH -1"), {"WIDTH is \"-1\""});
  refused("p.pcd", with("WIDTH 1", "WIDTH 99999999999999999999"), {"WIDTH is"});
  refused("p.pcd", with("WIDTH 1", "WIDTH 9999999999999999999"), {"2^40"});
  refused("p.pcd", with("WIDTH 1\nHEIGHT 2", "HEIGHT 2").replace(0, 0, ""), {"2 points, but of 2 x 2"});
  refused("p.pcd", with("SIZE 2 8 4 4 4", "SIZE 2 8 4 4"), {"SIZE has 4 entries for 5 fields"});
  refused("p.pcd", with("SIZE 2 8 4 4 4", "SIZE 2 8 3 4 4"), {"its y is 1 numbers of 3 bytes"});
  refused("p.pcd", with("SIZE 2 8", "SIZE 18446744073709551615 8"), {"too large"});
  refused("p.pcd", with("TYPE U F", "TYPE U G"), {"TYPE \"G\""});
  refused("p.pcd", with("COUNT 1 1 1 3 1", "COUNT 1 1 2 3 1"), {"its y is 2 numbers"});
  refused("p.pcd", with("COUNT 1 1 1 3", "COUNT 1 1 1 9999999"), {"too large"});
  refused("p.pcd", with("normal x", "normal w"), {"have no x"});
  refused("p.pcd", with("FIELDS intensity z y normal x\n", ""), {"SIZE has 5 entries for 0"});
  refused("p.pcd", with("VIEWPOINT", "VIEWPINT"), {"\"VIEWPINT\", which is unknown"});
  refused("p.pcd", "VERSION 0.7\n", {"no DATA"});
  refused("p.pcd", "hello\n", {"\"hello\", which is unknown"});
  refused("p.pcd", with("WIDTH 1\nHEIGHT 2", "WIDTH 0\nHEIGHT 2").replace(0, 0, ""), {"2 points, but of 0 x 2"});
}

TEST(Lzf, UnpacksWhatWasPackedAndNothingElse) {
  std::mt19937 random(2);
  for (int i = 0; i < 400; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    std::string data(random() % 2000, '\0');
    for (char& c : data) c = static_cast<char>(random() % static_cast<unsigned>(i % 5 + 1));
    const std::string packed = lzf_pack(data);
    const Bytes from(packed.begin(), packed.end());
    Bytes to(data.size());
    ASSERT_TRUE(detail::lzf_unpack(from, to));
    ASSERT_TRUE(std::equal(to.begin(), to.end(), data.begin(),
                           [](std::uint8_t a, char b) { return a == static_cast<std::uint8_t>(b); }));
    ASSERT_GE(from.size() * detail::kLzfBest, to.size());
    if (data.empty()) continue;
    ASSERT_FALSE(detail::lzf_unpack(std::span(from).first(from.size() - 1), to));
    Bytes other(data.size() + 1);
    ASSERT_FALSE(detail::lzf_unpack(from, other));
    other.resize(data.size() - 1);
    ASSERT_FALSE(detail::lzf_unpack(from, other));
    Bytes damaged = from;
    for (int k = 0; k < 20; ++k) {  // whatever comes out, nothing is read or written beyond the ends
      damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
      detail::lzf_unpack(damaged, to);
    }
  }
}

}  // namespace
}  // namespace blackleaf::test
