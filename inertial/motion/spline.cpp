#include <array>
#include <cmath>

#include "canyon/core/files/files.h"
#include "canyon/core/files/line_reader.h"
#include "canyon/core/units.h"
#include "canyon/inertial/motion/models.h"
#include "canyon/inertial/motion/pose_spline.h"

namespace canyon::inertial {
namespace {

constexpr double kLongest_s = 1e9;  // some 30 years
constexpr const char* kExpected = "t_s,x_m,y_m,z_m or t_s,x_m,y_m,z_m,yaw_deg,pitch_deg,roll_deg";

Result<PoseKnots> read_points(const std::string& path) {
  CANYON_TRY(std::string text, read_text_file(path));
  LineReader in(path, std::move(text));
  std::string_view line;
  if (!in.next(line)) return in.empty_file("points");
  const bool with_attitude = line == "t_s,x_m,y_m,z_m,yaw_deg,pitch_deg,roll_deg";
  if (!with_attitude && line != "t_s,x_m,y_m,z_m") return in.error("header \"" + std::string(line) + "\"", kExpected);
  PoseKnots knots;
  while (in.next(line)) {
    const auto fields = split(line, ",", false);
    if (fields.size() != (with_attitude ? 7u : 4u))
      return in.error(std::to_string(fields.size()) + " columns", kExpected);
    std::array<double, 7> v{};
    for (std::size_t i = 0; i < fields.size(); ++i) {
      CANYON_TRY(v[i], i >= 1 && i <= 3 ? parse_coordinate(in, fields[i]) : parse_number(in, fields[i]));
    }
    if (std::abs(v[0]) > kLongest_s)
      return in.error("\"" + std::string(fields[0]) + "\" is not a time", "seconds from -1e9 to 1e9");
    if (!knots.t_s.empty() && !(knots.t_s.back() < v[0]))
      return in.error("time does not increase", "points in the order of time");
    knots.t_s.push_back(v[0]);
    knots.p_WB.emplace_back(v[1], v[2], v[3]);
    if (with_attitude) knots.R_WB.push_back(rotation_from({v[4] * kDegree, v[5] * kDegree, v[6] * kDegree}));
  }
  const double first_s = knots.t_s.empty() ? 0.0 : knots.t_s.front();
  for (double& t : knots.t_s) t -= first_s;
  return knots;
}

}  // namespace

Result<PlacedMotion> make_spline(const MotionConfig& config) {
  if (config.file.empty()) return Error{.key = "file", .what = "no file given", .expected = kExpected};
  CANYON_TRY(const PoseKnots knots, read_points(config.file));
  const auto motion = make_pose_spline(knots, config.smoothing_s);
  if (!motion) return Error{.file = config.file, .what = motion.error().what, .expected = motion.error().expected};
  return PlacedMotion{.frame = frame_of(config), .motion = *motion};
}

}  // namespace canyon::inertial
