#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "canyon/mission/autonomy/perception/lane_reference.h"
#include "canyon/mission/autonomy/perception/street_weight.h"

namespace canyon::mission {
namespace {

struct SeenStreetParameters {
  double sigma_m = 1.0;
};
void visit(FieldVisitor& f, SeenStreetParameters& p) {
  f.number("sigma_m", p.sigma_m, {0.05, 20},
           "seen_street: 1-sigma of the middle of the free space as the street's, as cars park on one side");
}

constexpr double kSlice_m = 1.0;    // of the window
constexpr std::size_t kFewest = 8;  // slices with both sides
constexpr double kAlike_m = 2.0;    // within which the middle half of the slices must have their middles

/// The middle of the free space between what is seen left and right.
class SeenStreet final : public LaneReference {
 public:
  SeenStreet(const SeenStreetParameters& own, const StreetSidesParameters& p) : p_(p), weight_(p, own.sigma_m) {}

  double middle_m(const LaneTask& task) override {
    return weight_.middle_m(weight_.is_straight(task) ? seen_middle_m(task) : std::nullopt, task);
  }

 private:
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
    for (const Slice& slice : slices)
      if (const auto middle = weight_.between(slice.left, slice.right)) middles.push_back(*middle);
    if (middles.size() < kFewest) return std::nullopt;
    std::sort(middles.begin(), middles.end());
    const std::size_t n = middles.size();
    if (middles[3 * n / 4] - middles[n / 4] > kAlike_m) return std::nullopt;  // a crossing, or a bend
    return middles[n / 2];
  }

  StreetSidesParameters p_;
  StreetWeight weight_;
};

}  // namespace

std::unique_ptr<LaneReference> make_seen_street(const ModelParameters& own) {
  return std::make_unique<SeenStreet>(own.get<SeenStreetParameters>(), own.get<StreetSidesParameters>());
}

void seen_street_parameters(ModelParameters& section) {
  section.add<SeenStreetParameters>();
  section.add<StreetSidesParameters>();
}

}  // namespace canyon::mission
