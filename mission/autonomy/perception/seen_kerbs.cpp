#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "canyon/mission/autonomy/perception/kerb_rises.h"
#include "canyon/mission/autonomy/perception/lane_reference.h"
#include "canyon/mission/autonomy/perception/street_weight.h"

namespace canyon::mission {
namespace {

struct SeenKerbsParameters {
  double sigma_m = 0.15;
  double memory_m = 20.0;
};
void visit(FieldVisitor& f, SeenKerbsParameters& p) {
  f.number("kerb_sigma_m", p.sigma_m, {0.02, 20},
           "seen_kerbs: 1-sigma of the middle between the kerbs as the street's");
  f.number("kerb_memory_m", p.memory_m, {0, 100}, "seen_kerbs: how far behind a kerb that was seen still counts");
}

constexpr std::size_t kFewestPlaces = 6;  // of either kerb
constexpr std::size_t kMostPlaces = 600;
constexpr double kBand_m = 0.4;        // within which places are of one kerb
constexpr double kOfOneKerb_m = 0.15;  // and how far from its line, when that is known
constexpr double kMostLeaning = 0.1;   // of kerbs against the route: how wrong the heading may be
constexpr double kLeaningStep = 0.02;
constexpr double kTurned = 0.985;  // cosine, beyond which what was seen is of another street

/// A place as it lies to the vehicle: along the route, and to its left.
struct KerbPlace {
  double ahead_m, aside_m;
};

/// Two kerbs side by side, leaning alike against the route: places left and right of the vehicle, and aside over ahead.
struct KerbPair {
  double left_m = 0.0, right_m = 0.0, leaning = 0.0;
  double of_m(bool left) const { return left ? left_m : right_m; }
};

/// The middle of the densest band of sorted values, and how many lie in it.
std::pair<double, std::size_t> densest(const std::vector<double>& sorted) {
  std::pair<double, std::size_t> best{0.0, 0};
  for (std::size_t i = 0, j = 0; i < sorted.size(); ++i) {
    while (j < sorted.size() && sorted[j] - sorted[i] <= kBand_m) ++j;
    if (j - i > best.second) best = {0.5 * (sorted[i] + sorted[j - 1]), j - i};
  }
  return best;
}

/// Where most places of both sides lie on two lines; none where either side has too few, or most of its places lie
/// elsewhere.
std::optional<KerbPair> two_lines(const std::vector<KerbPlace>& places) {
  std::optional<KerbPair> best;
  std::size_t most = 0;
  const int steps = static_cast<int>(std::lround(kMostLeaning / kLeaningStep));
  for (int k = 0; k <= 2 * steps; ++k) {
    const double leaning = kLeaningStep * (k % 2 == 0 ? k / 2 : -(k + 1) / 2);  // the least first
    std::vector<double> left, right;
    for (const KerbPlace& place : places) {
      const double at_m = place.aside_m - leaning * place.ahead_m;
      (at_m > 0.0 ? left : right).push_back(at_m);
    }
    std::sort(left.begin(), left.end());
    std::sort(right.begin(), right.end());
    const auto [left_m, left_count] = densest(left);
    const auto [right_m, right_count] = densest(right);
    if (left_count < kFewestPlaces || right_count < kFewestPlaces) continue;
    if (2 * left_count < left.size() || 2 * right_count < right.size()) continue;
    if (left_count + right_count <= most) continue;
    most = left_count + right_count;
    best = KerbPair{left_m, right_m, leaning};
  }
  return best;
}

/// The same by least squares over the places on them.
std::optional<KerbPair> fitted(const std::vector<KerbPlace>& places, KerbPair lines) {
  for (const double within_m : {kBand_m, kOfOneKerb_m}) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    std::size_t count[2] = {0, 0};
    for (const KerbPlace& place : places) {
      const bool left = place.aside_m - lines.leaning * place.ahead_m > 0.0;
      if (std::abs(place.aside_m - lines.leaning * place.ahead_m - lines.of_m(left)) > within_m) continue;
      const Eigen::Vector3d row(left ? 1.0 : 0.0, left ? 0.0 : 1.0, place.ahead_m);
      A += row * row.transpose();
      b += place.aside_m * row;
      ++count[left ? 0 : 1];
    }
    if (count[0] < kFewestPlaces || count[1] < kFewestPlaces) return std::nullopt;
    const Eigen::LDLT<Eigen::Matrix3d> solved(A);
    if (solved.info() != Eigen::Success || !(solved.rcond() > 1e-8)) return std::nullopt;
    const Eigen::Vector3d x = solved.solve(b);
    lines = {x[0], x[1], x[2]};
  }
  return lines;
}

/// The middle between the kerbs of both sides, where the street goes straight on. The estimate's heading may be wrong:
/// kerbs may lean against the route, both alike, and count where the vehicle is.
class SeenKerbs final : public LaneReference {
 public:
  SeenKerbs(const SeenKerbsParameters& own, const StreetSidesParameters& p)
      : own_(own), p_(p), weight_(p, own.sigma_m) {}

  /// All that may be of a street's ground within its window.
  std::optional<KeptReturns> keeps() const override {
    const double reach_m = std::hypot(p_.window_m, p_.widest_m), room_m = 1.0 + 0.15 * reach_m;
    return KeptReturns{.low_m = -room_m, .high_m = room_m, .half_size_m = reach_m, .enough = 0};
  }

  double middle_m(const LaneTask& task) override {
    if (!weight_.is_straight(task)) {
      places_.clear();
      return weight_.middle_m(std::nullopt, task);
    }
    look(task);
    return weight_.middle_m(seen_middle_m(task), task);
  }

 private:
  void look(const LaneTask& task) {
    const Eigen::Vector2d u = task.route.direction(task.s_m);
    if (u.dot(along_) < kTurned) places_.clear();
    along_ = u;
    if (task.scan != nullptr && task.X_OL != nullptr && task.X_OB != nullptr)
      for (const Eigen::Vector2d& p : kerb_rises({.scan = *task.scan,
                                      .X_OL = *task.X_OL,
                                      .origin = task.body.p_m,
                                      .along = u,
                                      .ground_m = task.X_OB->p.z(),
                                      .up = task.X_OB->R * Eigen::Vector3d::UnitZ(),
                                      .ahead_m = p_.window_m,
                                      .beside_m = p_.widest_m}))
        places_.push_back(p);
    while (places_.size() > kMostPlaces) places_.pop_front();
    std::erase_if(places_, [&](const Eigen::Vector2d& p) { return u.dot(p - task.body.p_m) < -own_.memory_m; });
  }

  std::optional<double> seen_middle_m(const LaneTask& task) const {
    const Eigen::Vector2d left(-along_.y(), along_.x());
    std::vector<KerbPlace> places;
    for (const Eigen::Vector2d& p : places_) {
      const Eigen::Vector2d d = p - task.body.p_m;
      places.push_back({along_.dot(d), left.dot(d)});
    }
    std::optional<KerbPair> lines = two_lines(places);
    if (lines) lines = fitted(places, *lines);
    if (!lines) return std::nullopt;
    const double own_m = left.dot(task.body.p_m + task.from_O_to_W - task.route.at(task.s_m));
    return weight_.between(own_m + lines->left_m, own_m + lines->right_m);
  }

  SeenKerbsParameters own_;
  StreetSidesParameters p_;
  StreetWeight weight_;
  Eigen::Vector2d along_{0, 0};         ///< the street's direction when it looked last
  std::deque<Eigen::Vector2d> places_;  ///< of kerbs, in O
};

}  // namespace

std::unique_ptr<LaneReference> make_seen_kerbs(const ModelParameters& own) {
  return std::make_unique<SeenKerbs>(own.get<SeenKerbsParameters>(), own.get<StreetSidesParameters>());
}

void seen_kerbs_parameters(ModelParameters& section) {
  section.add<SeenKerbsParameters>();
  section.add<StreetSidesParameters>();
}

}  // namespace canyon::mission
