#include "plot/stroke_font.h"

#include <algorithm>
#include <array>
#include <vector>

#include "plot/utf8.h"

namespace blackleaf::detail {
namespace {

// A letter is polylines separated by spaces; a point is two digits, x and y. The baseline is y = 2, small letters
// reach y = 6, capitals y = 8, descenders y = 0. Six units are the height of capitals.
constexpr int kBaseline = 2;
constexpr double kUnitsPerHeight = 6;
constexpr int kBetween = 2;  // units between letters
constexpr int kSpace = 2;    // width of a space

// From '!' to '~'.
constexpr std::array<std::string_view, 94> kLetters = {
    "0804 0302",                         // !
    "0807 1817",                         // "
    "1218 3238 0444 0646",               // #
    "473818070615354443321203 2129",     // $
    "0248 0818170708 3343423233",        // %
    "44221203043728180742",              // &
    "0807",                              // '
    "18060412",                          // (
    "08161402",                          // )
    "2327 0446 0644",                    // *
    "0545 2327",                         // +
    "1301",                              // ,
    "0525",                              // -
    "0203",                              // .
    "0138",                              // /
    "122233372818070312",                // 0
    "062822",                            // 1
    "07183847460242",                    // 2
    "0718384746354443321203 2535",       // 3
    "32380444",                          // 4
    "480805354443321203",                // 5
    "4738180703123243443505",            // 6
    "084812",                            // 7
    "15060718384746351504031232434435",  // 8
    "0312324347381807061545",            // 9
    "0203 0506",                         // :
    "1301 1516",                         // ;
    "370533",                            // <
    "0444 0646",                         // =
    "073503",                            // >
    "071828373614 1312",                 // ?
    "3616143436 34444738180703123242",   // @
    "022842 1535",                       // A
    "02083847463505 3544433202",         // B
    "4738180703123243",                  // C
    "02082846442202",                    // D
    "48080242 0535",                     // E
    "480802 0535",                       // F
    "47381807031232434525",              // G
    "0208 4248 0545",                    // H
    "0208",                              // I
    "3833221203",                        // J
    "0208 4804 1542",                    // K
    "080242",                            // L
    "0208254842",                        // M
    "02084248",                          // N
    "123243473818070312",                // O
    "02083847463505",                    // P
    "123243473818070312 2442",           // Q
    "02083847463505 2542",               // R
    "473818070615354443321203",          // S
    "0848 2822",                         // T
    "080312324348",                      // U
    "082248",                            // V
    "0812263248",                        // W
    "0248 0842",                         // X
    "082548 2522",                       // Y
    "08480242",                          // Z
    "18080212",                          // [
    "0831",                              // backslash
    "08181202",                          // ]
    "061826",                            // ^
    "0141",                              // _
    "0817",                              // `
    "3632 3526160503122233",             // a
    "0802 0516263533221203",             // b
    "3526160503122233",                  // c
    "3832 3526160503122233",             // d
    "04343526160503122233",              // e
    "281712 0626",                       // f
    "3631201001 3526160503122233",       // g
    "0802 0516263532",                   // h
    "0602 0807",                         // i
    "161100 1817",                       // j
    "0802 3603 1432",                    // k
    "080312",                            // l
    "0602 05162522 25364542",            // m
    "0602 0516263532",                   // n
    "122233352616050312",                // o
    "0600 0516263533221203",             // p
    "3630 3526160503122233",             // q
    "0602 051626",                       // r
    "35261605142433221203",              // s
    "181322 0626",                       // t
    "0603122233 3632",                   // u
    "062246",                            // v
    "0612253246",                        // w
    "0236 0632",                         // x
    "0622 4610",                         // y
    "06360232",                          // z
    "28171605141322",                    // {
    "0108",                              // |
    "08171625141302",                    // }
    "05163445",                          // ~
};
constexpr std::string_view kBox = "0208484202";

// The letters of a text, one a character; a space is none.
std::vector<std::string_view> letters(std::string_view text) {
  std::vector<std::string_view> result;
  for (const char c : valid_utf8(text)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >> 6 == 0x2) continue;  // the rest of a character
    if (byte == ' ')
      result.emplace_back();
    else if (byte > ' ' && byte <= '~')
      result.push_back(kLetters[static_cast<std::size_t>(byte - '!')]);
    else
      result.push_back(kBox);
  }
  return result;
}

int width(std::string_view letter) {
  if (letter.empty()) return kSpace;
  int most = 0;
  for (std::size_t i = 0; i < letter.size(); i += letter[i] == ' ' ? 1u : 2u)
    if (letter[i] != ' ') most = std::max(most, letter[i] - '0');
  return most;
}

int width(const std::vector<std::string_view>& text) {
  int sum = text.empty() ? 0 : -kBetween;
  for (const std::string_view letter : text) sum += width(letter) + kBetween;
  return sum;
}

}  // namespace

double text_width(std::string_view text, double height_mm) {
  return width(letters(text)) * height_mm / kUnitsPerHeight;
}

void write_text(Polylines& lines, std::string_view text, const Eigen::Vector2d& at, double height_mm) {
  const double unit = height_mm / kUnitsPerHeight;
  int from = 0;
  std::vector<Eigen::Vector2d> line;
  for (const std::string_view letter : letters(text)) {
    for (std::size_t i = 0; i <= letter.size(); i += 2) {
      if (i == letter.size() || letter[i] == ' ') {
        if (!line.empty()) lines.add(line);
        line.clear();
        if (i == letter.size()) break;
        ++i;
      }
      line.push_back(at + unit * Eigen::Vector2d(from + letter[i] - '0', letter[i + 1] - '0' - kBaseline));
    }
    from += width(letter) + kBetween;
  }
}

std::string shortened(std::string_view text, double height_mm, double room_mm) {
  std::string whole = valid_utf8(text);
  if (text_width(whole, height_mm) <= room_mm) return whole;
  while (!whole.empty()) {
    // A whole character goes.
    while (!whole.empty() && static_cast<unsigned char>(whole.back()) >> 6 == 0x2) whole.pop_back();
    if (!whole.empty()) whole.pop_back();
    if (text_width(whole + "...", height_mm) <= room_mm) break;
  }
  return whole + "...";
}

}  // namespace blackleaf::detail
