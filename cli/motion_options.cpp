#include "motion_options.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "blackleaf/error.h"
#include "blackleaf/measures.h"
#include "files.h"
#include "options.h"

namespace blackleaf::cli {
namespace {

Eigen::Vector3d centre_of_rotation(const std::string& about, const Octree& octree) {
  if (about == "corner") return Eigen::Vector3d::Zero();
  if (about == "centre" || about == "center") return Eigen::Vector3d::Constant(octree.side() / 2.0);
  if (about == "centroid") {
    const auto point = centroid(octree);
    if (!point)
      throw Error(ErrorCode::bad_argument, "--about centroid: an empty solid has no centroid",
                  "use corner, centre or x,y,z");
    return *point;
  }
  if (about.find(',') == std::string::npos)
    throw Error(ErrorCode::bad_argument, fmt::format("--about is '{}', which is no place", about),
                "use corner, centre, centroid or x,y,z");
  return parse_vector("--about", about);
}

}  // namespace

void MotionOptions::add_to(App& app, const std::string& of) {
  Option* rotate =
      app.add_option("--rotate", rotations_, "turn " + of + " about an axis, right-handed; repeatable, in order")
          ->type_name("x,y,z:degrees")
          ->allow_extra_args(false);
  Option* translate = add_text(app, "--translate", translation_, "x,y,z", "then shift " + of + ", in voxels");
  add_text(app, "--about", about_, "WHERE",
           "point that rotations leave in place: corner (default), centre, centroid or x,y,z");
  add_text(app, "--matrix", matrix_, "FILE", "4x4 rigid matrix, sixteen numbers row by row, in voxels")
      ->excludes(rotate)
      ->excludes(translate);
}

void MotionOptions::add_reflection_to(App& app, const std::string& of) {
  add_text(app, "--reflect", reflect_, "AXES",
           "first mirror " + of + " along x, y or z, or several like x,z, about the universe's centre or --about");
}

LatticeSymmetry MotionOptions::reflection() const {
  LatticeSymmetry result;
  if (!reflect_) return result;
  const std::string& text = *reflect_;
  // One letter or several with commas between, each once.
  bool good = text.size() % 2 == 1;
  for (std::size_t i = 0; good && i < text.size(); ++i) {
    const int axis = text[i] - 'x';
    good = i % 2 == 1 ? text[i] == ',' : axis >= 0 && axis < 3 && !result.reversed(axis);
    if (good && i % 2 == 0) result = LatticeSymmetry::reflection(axis) * result;
  }
  if (!good)
    throw Error(ErrorCode::bad_argument, fmt::format("--reflect is '{}', which names no axes", text),
                "use x, y or z, or several like x,z");
  return result;
}

Motion MotionOptions::motion(const Octree& octree) const {
  Motion motion;
  if (matrix_) {
    motion = read_matrix(*matrix_);
  } else {
    for (const std::string& next : rotations_) motion = parse_rotation("--rotate", next) * motion;
    if (translation_) motion = Motion::translation(parse_vector("--translate", *translation_)) * motion;
  }
  if (!about_) return motion;
  const Eigen::Vector3d centre = centre_of_rotation(*about_, octree);
  // A reflection about `centre` is one about the universe's centre and then a shift.
  const Eigen::Vector3d off = centre - Eigen::Vector3d::Constant(octree.side() / 2.0);
  return motion.about(centre) * Motion::translation(off - reflection().matrix() * off);
}

Json MotionOptions::as_json(const Motion& motion) const {
  Json options = Json::object();
  if (reflect_) options["reflect"] = *reflect_;
  if (!rotations_.empty()) options["rotate"] = rotations_;
  if (translation_) options["translate"] = *translation_;
  if (about_) options["about"] = *about_;
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < 3; ++i)
    rows.push_back(
        {motion.rotation()(i, 0), motion.rotation()(i, 1), motion.rotation()(i, 2), motion.translation()[i]});
  rows.push_back({0, 0, 0, 1});
  options["matrix"] = rows;
  return options;
}

Motion read_matrix(const std::string& path) {
  check_input(path, "a matrix file");
  std::ifstream file(path, std::ios::binary);
  std::string text;
  // A matrix is a few hundred bytes; whatever is longer is something else and need not be read.
  constexpr std::size_t kLongest = 1 << 16;
  for (char c; text.size() < kLongest && file.get(c);) text.push_back(c);
  const std::string form = "write sixteen numbers row by row, the last row 0 0 0 1";

  std::vector<double> numbers;
  const std::string separators = " \t\r\n,;[]";
  for (std::size_t at = text.find_first_not_of(separators); at != std::string::npos && numbers.size() <= 16;) {
    const std::size_t end = text.find_first_of(separators, at);
    numbers.push_back(parse_number(fmt::format("entry {} of matrix '{}'", numbers.size() + 1, path),
                                   text.substr(at, end == std::string::npos ? end : end - at)));
    at = text.find_first_not_of(separators, end);
  }
  if (numbers.size() != 16)
    throw Error(ErrorCode::bad_input,
                fmt::format("matrix '{}' has {} numbers instead of 16", path,
                            numbers.size() > 16 ? "more than 16" : std::to_string(numbers.size())),
                form);
  const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
  const Eigen::Vector4d last(0, 0, 0, 1);
  if (matrix.row(3).transpose() != last && matrix.col(3) == last)
    throw Error(ErrorCode::bad_input, fmt::format("matrix '{}' is written column by column", path),
                "write it row by row: the translation is the last column");
  try {
    return Motion::from(matrix);
  } catch (const Error& error) {
    throw Error(ErrorCode::bad_input, fmt::format("matrix '{}': {}", path, error.what()));
  }
}

void LeavingOptions::add_to(App& app) {
  Option* clip_flag = app.add_flag("--clip", clip_, "drop what leaves the universe");
  app.add_flag("--grow", grow_, "double the universe until it holds everything")->excludes(clip_flag);
}

}  // namespace blackleaf::cli
