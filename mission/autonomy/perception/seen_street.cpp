#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "canyon/mission/autonomy/perception/lane_reference.h"

namespace canyon::mission {
namespace {

struct SeenStreetParameters {
  double sigma_m = 1.0;
  double narrowest_m = 5.0;
  double widest_m = 25.0;
  double window_m = 20.0;
  double slew_m_s = 0.5;
  double doubt_s = 3.0;
};
void visit(FieldVisitor& f, SeenStreetParameters& p) {
  f.number("sigma_m", p.sigma_m, {0.05, 20},
           "seen_street: 1-sigma of the middle of the free space as the street's, as cars park on one side");
  f.number("narrowest_m", p.narrowest_m, {1, 50}, "seen_street: free space that is narrower is not the whole street");
  f.number("widest_m", p.widest_m, {2, 120}, "seen_street: free space that is wider is no street");
  f.number("window_m", p.window_m, {4, 60}, "seen_street: how far ahead it looks for both sides");
  f.number("slew_m_s", p.slew_m_s, {0.01, 10}, "seen_street: how fast it moves the lane");
  f.number(
      "doubt_s", p.doubt_s, {0, 600},
      "seen_street: after so long with a street where the estimate's own sigma cannot have it, the street is right");
}

constexpr double kStraight_1_m = 0.01;  // of the route, over the window
constexpr double kSlice_m = 1.0;        // of the window
constexpr std::size_t kFewest = 8;      // slices with both sides
constexpr double kAlike_m = 2.0;        // within which the middle half of the slices must have their middles
constexpr double kDoubt = 3.0;  // sigma beyond which the estimate is no longer believed to be as good as it says

/// The middle of the free space between what is seen left and right, weighed against the estimate by their variances. A
/// middle that the estimate's own sigma cannot explain counts as that much estimate's error: filters that follow
/// reflected signals are surer than right.
class SeenStreet final : public LaneReference {
 public:
  explicit SeenStreet(const SeenStreetParameters& p) : p_(p) {}

  double middle_m(const LaneTask& task) override {
    const std::optional<double> seen = is_straight(task) ? seen_middle_m(task) : std::nullopt;
    // Where nothing is seen, the route alone.
    const double wanted = seen ? weight(*seen, task.sigma_m, task.dt_s) * *seen : 0.0;
    const double most = p_.slew_m_s * task.dt_s;
    middle_ += std::clamp(wanted - middle_, -most, most);
    return middle_;
  }

 private:
  double weight(double seen_m, double sigma_m, double dt_s) {
    const double own2 = p_.sigma_m * p_.sigma_m;
    double estimate2 = sigma_m * sigma_m;
    const double expected2 = kDoubt * kDoubt * (own2 + estimate2);
    doubted_s_ = seen_m * seen_m > expected2 ? doubted_s_ + dt_s : 0.0;
    if (doubted_s_ > p_.doubt_s) estimate2 += seen_m * seen_m - expected2;
    return estimate2 / (estimate2 + own2);
  }

  bool is_straight(const LaneTask& task) const {
    for (double x = 0.0; x <= p_.window_m; x += 2.0)
      if (std::abs(task.route.curvature(task.s_m + x)) > kStraight_1_m) return false;
    const Eigen::Vector2d u = task.route.direction(task.s_m);
    return u.dot(task.body.forward()) > 0.9;
  }

  std::optional<double> seen_middle_m(const LaneTask& task) const {
    struct Slice {
      double left = 1e9, right = -1e9;
    };
    std::vector<Slice> slices(static_cast<std::size_t>(p_.window_m / kSlice_m) + 1);
    const Eigen::Vector2d u = task.route.direction(task.s_m), left(-u.y(), u.x());
    const Eigen::Vector2d origin = task.route.at(task.s_m) - task.from_O_to_W;
    const double own = left.dot(task.body.p_m - origin);
    for (const Eigen::Vector2d& cell : task.blocked.all()) {
      const Eigen::Vector2d d = cell - origin;
      const double along = u.dot(d), aside = left.dot(d);
      if (along < 0.0 || along >= static_cast<double>(slices.size()) * kSlice_m) continue;
      Slice& slice = slices[static_cast<std::size_t>(along / kSlice_m)];
      if (aside > own)
        slice.left = std::min(slice.left, aside);
      else
        slice.right = std::max(slice.right, aside);
    }
    std::vector<double> middles;
    for (const Slice& slice : slices) {
      const double width = slice.left - slice.right;
      if (width >= p_.narrowest_m && width <= p_.widest_m) middles.push_back(0.5 * (slice.left + slice.right));
    }
    if (middles.size() < kFewest) return std::nullopt;
    std::sort(middles.begin(), middles.end());
    const std::size_t n = middles.size();
    if (middles[3 * n / 4] - middles[n / 4] > kAlike_m) return std::nullopt;  // a crossing, or a bend
    return middles[n / 2];
  }

  SeenStreetParameters p_;
  double middle_ = 0.0, doubted_s_ = 0.0;
};

}  // namespace

std::unique_ptr<LaneReference> make_seen_street(const ModelParameters& own) {
  return std::make_unique<SeenStreet>(own.get<SeenStreetParameters>());
}

void seen_street_parameters(ModelParameters& section) {
  section.add<SeenStreetParameters>();
}

}  // namespace canyon::mission
