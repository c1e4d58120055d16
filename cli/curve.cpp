// blackleaf curve: node numbers and voxels of the Millar curve (MHF92).
#include "blackleaf/curve.h"

#include <fmt/format.h>

#include <sstream>

#include "blackleaf/error.h"
#include "commands.h"
#include "files.h"
#include "options.h"

namespace blackleaf::cli {
namespace {

struct Point {
  std::uint64_t number = 0;
  curve::Voxel voxel;
};

Point from_number(int order, const std::string& text) {
  const auto last = (std::int64_t{1} << (3 * order)) - 1;
  const auto number = static_cast<std::uint64_t>(parse_integer("node number", text, 0, last));
  return {number, curve::voxel(order, number)};
}

Point from_voxel(int order, const std::string& text) {
  const std::int64_t side = std::int64_t{1} << order;
  const auto voxel = parse_integer_vector("voxel", text);
  for (const std::int64_t coordinate : voxel)
    if (coordinate < 0 || coordinate >= side)
      throw Error(ErrorCode::bad_argument, fmt::format("voxel {} is outside the curve of order {}", text, order),
                  fmt::format("its coordinates must be from 0 to {}", side - 1));
  const curve::Voxel at{static_cast<std::int32_t>(voxel[0]), static_cast<std::int32_t>(voxel[1]),
                        static_cast<std::int32_t>(voxel[2])};
  return {curve::number(order, at), at};
}

}  // namespace

int run_curve(Session& session) {
  std::vector<std::string> items;
  std::optional<int> order;
  bool inverse = false;
  session.app()
      .add_option("ITEM", items, "node numbers, or voxels x,y,z with --inverse; - reads them from standard input")
      ->required()
      ->type_name("");
  add_integer(session.app(), "--order", order, 1, kMaxDepth, "order of the curve, 1 to 20: it fills 2^N voxels a side")
      ->required();
  session.app().add_flag("--inverse", inverse, "from voxels to numbers");
  session.add_json();
  session.set_example("blackleaf curve --order 2 30          (prints 0 1 3)");
  if (!session.parse()) return kDone;

  if (items == std::vector<std::string>{"-"}) {
    const std::vector<std::uint8_t> bytes = read_bytes("-");
    std::istringstream words(std::string(bytes.begin(), bytes.end()));
    items.clear();
    for (std::string word; words >> word;) items.push_back(word);
  }
  Json points = Json::array();
  std::string text;
  for (const std::string& item : items) {
    const Point point = inverse ? from_voxel(*order, item) : from_number(*order, item);
    const auto& [x, y, z] = point.voxel;
    if (session.json())
      points.push_back({{"number", point.number}, {"voxel", {x, y, z}}});
    else
      text += inverse ? fmt::format("{}\n", point.number) : fmt::format("{} {} {}\n", x, y, z);
  }
  if (session.json())
    print_out(Json{{"order", *order}, {"points", points}});
  else
    print_out(text);
  return kDone;
}

}  // namespace blackleaf::cli
