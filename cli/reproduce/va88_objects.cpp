// Silhouettes are functions of u (to the right) and v (upward), counted in half voxels of a universe of 128 from its
// middle: pixels' centres have odd places there, in smaller universes odd multiples of 128 / side, so that everything
// is a comparison of whole numbers. examples/va88/make_silhouettes.py has the same shapes; a test compares the images.
#include "va88_objects.h"

#include <cassert>
#include <cstdlib>
#include <functional>

namespace blackleaf::cli {
namespace {

constexpr int kSide = 128;

using Shape = std::function<bool(int u, int v)>;

struct Seen {
  Eigen::Vector3d view;
  Shape shape;
};

Shape disc(int radius) {
  return [=](int u, int v) { return u * u + v * v <= radius * radius; };
}
Shape box(int left, int right, int low, int high) {
  return [=](int u, int v) { return left <= u && u <= right && low <= v && v <= high; };
}
// Upright and symmetric, its base at v = low, its tip at v = high.
Shape triangle(int half_base, int low, int high) {
  return [=](int u, int v) { return v >= low && std::abs(u) * (high - low) <= half_base * (high - v); };
}
Shape diamond(int radius) {
  return [=](int u, int v) { return std::abs(u) + std::abs(v) <= radius; };
}
Shape either(Shape a, Shape b) {
  return [a = std::move(a), b = std::move(b)](int u, int v) { return a(u, v) || b(u, v); };
}
Shape without(Shape whole, Shape hole) {
  return [a = std::move(whole), b = std::move(hole)](int u, int v) { return a(u, v) && !b(u, v); };
}

// The coffee cup: a body that widens upward, and a handle to the right, open in the front view.
bool cup_body(int u, int v) { return -84 <= v && v <= 84 && 14 * std::abs(u) <= 14 * 56 + (v + 84); }
bool cup_handle(int u, int v) {
  const int square = (u - 64) * (u - 64) + v * v;
  return u >= 56 && 30 * 30 <= square && square <= 46 * 46;
}

const Eigen::Vector3d kFront(0, -1, 0), kRight(1, 0, 0), kTop(0, 0, 1);

std::vector<Seen> from_three_sides(const Shape& front, const Shape& right, const Shape& top) {
  return {{kFront, front}, {kRight, right}, {kTop, top}};
}

std::vector<Seen> cone() {
  const Shape side = triangle(96, -96, 96);
  std::vector<Seen> seen = {{kTop, disc(96)}};
  for (const Eigen::Vector3d& view :
       {kFront, kRight, Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(1, -1, 0), Eigen::Vector3d(2, 1, 0),
        Eigen::Vector3d(2, -1, 0), Eigen::Vector3d(1, 2, 0), Eigen::Vector3d(1, -2, 0)})
    seen.push_back({view, side});
  return seen;
}

// From all faces, edges and corners of a cube.
std::vector<Seen> sphere() {
  const Shape round = disc(112);
  std::vector<Seen> seen = from_three_sides(round, round, round);
  for (const Eigen::Vector3d& view :
       {Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(1, -1, 0), Eigen::Vector3d(1, 0, 1), Eigen::Vector3d(1, 0, -1),
        Eigen::Vector3d(0, 1, 1), Eigen::Vector3d(0, 1, -1), Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(1, 1, -1),
        Eigen::Vector3d(1, -1, 1), Eigen::Vector3d(1, -1, -1)})
    seen.push_back({view, round});
  return seen;
}

// The object that hides parts of itself: two towers and a step on a base, with a notch, and a window in the taller
// tower.
std::vector<Seen> blocks() {
  const Shape base = box(-96, 96, -96, -48);
  return from_three_sides(
      without(either(either(base, box(-96, -32, -96, 80)), box(48, 96, -96, 16)), box(-80, -48, 16, 48)),
      either(either(base, box(-32, 96, -96, 16)), box(32, 96, -96, 80)),
      without(box(-96, 96, -96, 96), box(-16, 32, -96, -16)));
}

Silhouette picture_of(const Seen& seen, int side) {
  Silhouette silhouette;
  silhouette.width = silhouette.height = side;
  silhouette.view = seen.view;
  silhouette.pixel_size = 1;
  silhouette.pixels.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  const auto place = [&](int pixel) { return (2 * pixel + 1 - side) * (kSide / side); };
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      silhouette.pixels.push_back(seen.shape(place(column), -place(row)) ? 1 : 0);
  return silhouette;
}

}  // namespace

Va88Object va88_object(int figure, int depth) {
  assert(figure >= kVa88FirstFigure && figure <= kVa88LastFigure && depth >= 1 && depth <= 7);
  const Shape tall = box(-80, 80, -96, 96), tip = triangle(96, -96, 96), square = box(-96, 96, -96, 96);
  std::string name;
  std::vector<Seen> seen;
  switch (figure) {
    case 5:
      name = "cylinder", seen = from_three_sides(tall, tall, disc(80));
      break;
    case 6:
      name = "cone", seen = cone();
      break;
    case 7:
      name = "sphere", seen = sphere();
      break;
    case 8:
      name = "pyramid", seen = from_three_sides(tip, tip, square);
      break;
    case 9:
      name = "cup";
      seen = from_three_sides(either(cup_body, cup_handle), cup_body, either(disc(68), box(0, 110, -12, 12)));
      break;
    case 10:
      name = "blocks", seen = blocks();
      break;
    default:
      name = "diamond", seen = from_three_sides(diamond(112), diamond(112), diamond(112));
      break;
  }
  Va88Object object{figure, name, {}};
  for (const Seen& one : seen) object.silhouettes.push_back(picture_of(one, 1 << depth));
  return object;
}

}  // namespace blackleaf::cli
