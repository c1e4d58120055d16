// Pen order: in which order and direction a plotter draws the lines of a picture, and how far its pen travels.
#pragma once

#include <cstddef>

#include "blackleaf/picture.h"

namespace blackleaf {

/// What drawing a picture costs a plotter that starts at the lower left corner of the page with its pen up and draws
/// layer after layer. A polyline that begins where the one before it in the same layer ended (to 1e-6 mm) is drawn
/// without lifting the pen.
struct PenTravel {
  std::size_t strokes = 0;  // straight pieces
  double down_mm = 0;       // drawn; as many dashes are not counted apart
  double up_mm = 0;         // travelled between lines; the way home is not counted
  std::size_t lifts = 0;    // times the pen is lowered, and so lifted
};

/// O(points).
PenTravel pen_travel(const Picture& picture);

enum class Joining {
  chains,   // lines that meet end to end become one polyline
  strokes,  // every straight piece stays a polyline of its own, those of a chain in a row
};

/// The same lines in an order, and directions, that keep the pen's travel short, within each layer. Layers with dashed
/// pens keep their lines apart, so that each begins with a dash; all others are first joined into the fewest chains
/// there can be (by Euler's theorem: half the number of points where an odd number of ends meet, and one for each
/// connected part without such points). Up to nine chains are brought into the best order there is; more into that of
/// the nearest neighbour, improved by 2-opt and Or-opt moves; closed chains then begin where the pen comes from. The
/// pen never travels farther than for the picture as it was. Deterministic; O(n log n) for n lines in practice.
Picture in_pen_order(const Picture& picture, Joining joining = Joining::chains);

}  // namespace blackleaf
