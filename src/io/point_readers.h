// Readers of single point formats, and the sink that they write to.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "blackleaf/error.h"
#include "blackleaf/points_file.h"
#include "file/input_file.h"

namespace blackleaf::detail {

/// Counts points and passes them on in pieces.
class PointSink {
 public:
  using Take = std::function<void(std::span<const Eigen::Vector3d>)>;
  /// `size`: bytes that will be read, for progress.
  PointSink(const Take& take, const Work& work, std::uint64_t size) : take_(take), work_(work), size_(size) {
    piece_.reserve(kPiece);
  }

  void add(const Eigen::Vector3d& point) {
    piece_.push_back(point);
    if (piece_.size() == kPiece) flush();
  }
  /// How far the reader is, in bytes.
  void reached(std::uint64_t position) { position_ = position; }
  /// Call once, at the end.
  PointsInfo finish() {
    flush();
    return info_;
  }

 private:
  static constexpr std::size_t kPiece = std::size_t{1} << 16;

  void flush() {
    for (const Eigen::Vector3d& point : piece_) {
      if (point.allFinite())
        info_.box.extend(point);
      else
        ++info_.not_finite;
    }
    info_.points += piece_.size();
    if (!piece_.empty()) take_(piece_);
    piece_.clear();
    const double done = size_ == 0 ? 1 : static_cast<double>(position_) / static_cast<double>(size_);
    if (work_.progress && !work_.progress(std::min(done, 1.0))) throw Error(ErrorCode::cancelled, "interrupted");
  }

  const Take& take_;
  const Work& work_;
  std::uint64_t size_, position_ = 0;
  std::vector<Eigen::Vector3d> piece_;
  PointsInfo info_;
};

/// The words of a line between blanks, one after the other.
class WordsOfLine {
 public:
  explicit WordsOfLine(std::string_view line) : rest_(line) {}
  /// Empty at the end.
  std::string_view next() {
    const std::size_t begin = rest_.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return {};
    rest_.remove_prefix(begin);
    const std::string_view word = rest_.substr(0, rest_.find_first_of(kBlanks));
    rest_.remove_prefix(word.size());
    return word;
  }

 private:
  static constexpr std::string_view kBlanks = " \t\v\f";
  std::string_view rest_;
};

/// Throw Error(bad_input); `name` is the file's. Requires: file.is_regular().
void read_text_points(const InputFile& file, const std::string& name, PointSink& sink);
void read_ply_points(const InputFile& file, const std::string& name, PointSink& sink);
void read_pcd_points(const InputFile& file, const std::string& name, PointSink& sink);

}  // namespace blackleaf::detail
