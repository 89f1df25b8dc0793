#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/bounce.h"
#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/gnss/paths/diffraction/mirror_borders.h"
#include "canyon/gnss/paths/need/path_question.h"
#include "canyon/gnss/paths/need/reflection_bound.h"

namespace canyon::gnss {

namespace {

constexpr double kShortestWave_m = 0.18;  // of L1 and G1, the highest carriers that are received, 0.187 m
constexpr std::int64_t kMostTried = 2'000'000;
constexpr double kRounding = 1e-6;

/// The image search of image_search.cpp with a ball in place of the antenna and the satellites of a span of time in
/// place of those of an epoch: every sequence of facets that the search would follow from any point of the ball is
/// followed here. Depth first, and done with the first sequence through which a satellite may be seen, and that
/// reflects enough of it to be followed: by the reflectances of its walls at that satellite's incidence, and by their
/// sizes. A plane wave has the same incidence wherever it meets a plane, so that this needs no ball.
class Search {
 public:
  Search(int order, const PathQuestion& q) : q_(q), order_(order), facets_(q.scene.facets().facets()) {
    weakest_ = std::pow(10.0, std::min(q.limits.weakest_db, q.limits.weakest_nlos_db) / 20.0);
    reach_per_area_ =
        q.limits.finite_facets ? 1.0 / (kShortestWave_m * weakest_) : std::numeric_limits<double>::infinity();
    if (q.limits.reflection_borders)
      bend_m_ =
          largest_detour_m(largest_border_nu(std::min(q.limits.weakest_db, q.limits.weakest_nlos_db)), kLongestWave_m);
    for (const scene::Material& material : q.scene.materials()) reflect_.emplace_back(material, q.limits.roughness_m);
  }

  Need run() {
    Need need{.effect = kReflections[order_ - 1]};
    if (extend(1, q_.antenna(), nullptr)) {
      need.reason = tried_ > kMostTried ? "too many ways over walls to try them all" : found();
      return need;
    }
    need.verdict = Verdict::kNotNeeded;
    need.reason = facets_.empty() ? "there are no walls" : "no walls mirror a satellite onto the corridor";
    if (strongest_ > 0.0) {
      char text[120];
      std::snprintf(text, sizeof text,
                    "what walls mirror of a satellite is below %.1f dB, and not followed below %.1f dB",
                    20.0 * std::log10(strongest_), 20.0 * std::log10(weakest_));
      need.reason = text;
    }
    return need;
  }

 private:
  std::string found() const {
    std::string over, last;
    for (int k = 0; k < order_; ++k) {
      const std::string& name = q_.scene.objects()[facets_[sequence_[static_cast<std::size_t>(k)]].object].name;
      if (name != last) over += (over.empty() ? "" : " and ") + name;
      last = name;
    }
    char level[48];
    std::snprintf(level, sizeof level, ", %.0f dB at most", 20.0 * std::log10(strongest_));
    return over + " may mirror " + seen_.str() + level;
  }

  /// May a wave leave the facet at the outer end of the sequence for the ball `image`, seen through `last` if any?
  bool extend(int count, const Ball& image, const scene::Facet* last) {
    for (std::uint32_t i = 0; i < facets_.size(); ++i) {
      const scene::Facet& f = facets_[i];
      if (++tried_ > kMostTried) return true;
      if (&f == last || !in_reach(f, image) || (last != nullptr && !seen_through(image, *last, f))) continue;
      sequence_[static_cast<std::size_t>(count - 1)] = i;
      images_[static_cast<std::size_t>(count - 1)] = image;
      const double to_plane_m = f.normal_W.dot(image.center_W) - f.offset_m;
      const Ball mirrored{image.center_W - 2.0 * to_plane_m * f.normal_W, image.radius_m};
      if (count < order_ ? extend(count + 1, mirrored, &f) : satellite(mirrored, f)) return true;
    }
    return false;
  }

  bool satellite(const Ball& image, const scene::Facet& f) {
    const Ball around{f.center_W, f.radius_m + beside_m(f, image)};
    for (auto seen = q_.sky.through(image, around); seen; seen = q_.sky.through(image, around, *seen + 1)) {
      const double left = left_of(q_.sky.directions[*seen].s_W);
      strongest_ = std::max(strongest_, left);
      if (left < weakest_) continue;
      strongest_ = left;
      seen_ = q_.sky.directions[*seen].sv;
      return true;
    }
    return false;
  }

  /// What the sequence leaves at most of the field of a satellite that stands within the span's spread of s.
  double left_of(const Eigen::Vector3d& s_W) const {
    const double spread = q_.sky.spread_rad + kRounding;  // a cosine changes by no more than its angle
    Eigen::Vector3d towards_W = s_W;
    double left = 1.0;
    for (int k = order_; k-- > 0;) {
      const scene::Facet& f = facets_[sequence_[static_cast<std::size_t>(k)]];
      const double cosine = f.normal_W.dot(towards_W), most = std::min(1.0, cosine + spread);
      if (most <= 0.0) return 0.0;  // met from behind
      left *= reflect_[f.material].from(cosine - spread);
      if (q_.limits.finite_facets) {
        const Ball& image = images_[static_cast<std::size_t>(k)];
        const double near_m = (f.center_W - image.center_W).norm() - f.radius_m - image.radius_m;
        // Beside its borders what fades out need not add up to so little.
        if (q_.limits.reflection_borders)
          left *= kMostMirrored;
        else if (near_m > 0.0)
          left *= std::min(1.0, f.area_m2 * most / (kShortestWave_m * near_m));
      }
      towards_W -= 2.0 * cosine * f.normal_W;
    }
    return left;
  }

  /// Does the facet face some point of the ball, and is it, if small, near enough to reflect enough?
  bool in_reach(const scene::Facet& f, const Ball& image) const {
    if (q_.scene.materials()[f.material].rf_absorbing) return false;
    const double to_plane_m = f.normal_W.dot(image.center_W) - f.offset_m + image.radius_m;
    if (to_plane_m <= 0.0) return false;
    const double distance_m = (f.center_W - image.center_W).norm() - f.radius_m - image.radius_m;
    return distance_m <= 0.0 || distance_m * distance_m <= reach_per_area_ * f.area_m2 * to_plane_m;
  }

  /// How far from a facet, across the way, a wave may pass that its borders still send on.
  double beside_m(const scene::Facet& f, const Ball& image) const {
    return std::sqrt(2.0 * bend_m_ * ((f.center_W - image.center_W).norm() + f.radius_m + image.radius_m));
  }

  /// May a straight line from the ball behind `window` pass it and meet `f` in front of it?
  bool seen_through(const Ball& image, const scene::Facet& window, const scene::Facet& f) const {
    const double f_wide_m = f.radius_m + beside_m(f, image);
    if (window.normal_W.dot(f.center_W) - window.offset_m < -f_wide_m) return false;
    const Eigen::Vector3d a = window.center_W - image.center_W, b = f.center_W - image.center_W;
    const double a_m = a.norm(), b_m = b.norm();
    const double a_wide_m = window.radius_m + beside_m(window, image) + image.radius_m;
    const double b_wide_m = f_wide_m + image.radius_m;
    if (a_m <= a_wide_m || b_m <= b_wide_m) return true;
    const double wide_rad = std::asin(a_wide_m / a_m) + std::asin(b_wide_m / b_m) + 1e-6;
    return wide_rad >= kPi || a.dot(b) >= std::cos(wide_rad) * a_m * b_m;
  }

  const PathQuestion& q_;
  int order_;
  const std::vector<scene::Facet>& facets_;
  double weakest_ = 0.0, reach_per_area_ = 0.0;
  double bend_m_ = 0.0;                   // longest detour over a border that sends on
  std::vector<ReflectionBound> reflect_;  // of each material
  std::array<Ball, SignalPath::kMaxReflections> images_;
  double strongest_ = 0.0;  // of what has been seen so far; in the end of what was found
  std::array<std::uint32_t, SignalPath::kMaxReflections> sequence_{};
  SatelliteId seen_;
  std::int64_t tried_ = 0;
};

}  // namespace

Need reflection_need(int order, const PathQuestion& question) {
  return Search(order, question).run();
}

}  // namespace canyon::gnss
