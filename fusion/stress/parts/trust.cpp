// What is made of innovations that go on: a filter that has lost its way, by time, way, number and how places go
// together; fuzzy rules; and the settings that stand where nobody gives any.
#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/stress/looks.h"
#include "canyon/fusion/acceptance/acceptance.h"
#include "canyon/fusion/consistency.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/parts/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

/// A place that is measured beside the estimate, fix by fix.
struct PlaceAt {
  double t_s = 0.0;
  PlaceBeside place;
  double nis = 300.0;
  Vector3d moved_by_this = Vector3d::Zero(), moved_by_others = Vector3d::Zero();  ///< before it comes
};

constexpr double kPlaceVariance = 4.0;

class Trusted {
 public:
  explicit Trusted(const std::string& row, const std::string& keys = "")
      : acceptance_(model_row(acceptance_models(), row).make(configured(keys).own)) {
    acceptance_->start();
  }
  Decision decide(double t_s, const Vector3d& residual, double R, double predicted, double nis,
                  const PlaceBeside* place = nullptr) {
    const Measurement::Vector r = residual;
    const Measurement::Square noise = R * Measurement::Square::Identity(3, 3),
                              known = predicted * Measurement::Square::Identity(3, 3);
    return acceptance_->decide({.t = GpsTime::from_week_sow(1590, 1000.0) + t_s,
                                .residual = r,
                                .R = noise,
                                .predicted = known,
                                .nis = nis,
                                .place = place});
  }
  Acceptance& operator*() { return *acceptance_; }

 private:
  std::unique_ptr<Acceptance> acceptance_;
};

/// The number of the first that makes the filter count as lost, of 400; -1: none.
int first_found(const std::string& row, const std::string& keys, const std::function<PlaceAt(int)>& at,
                Decision* made = nullptr) {
  Trusted trusted(row, keys);
  for (int k = 0; k < 400; ++k) {
    const PlaceAt now = at(k);
    if (!now.moved_by_this.isZero(0.0)) (*trusted).moved(now.moved_by_this, true);
    if (!now.moved_by_others.isZero(0.0)) (*trusted).moved(now.moved_by_others, false);
    PlaceBeside place = now.place;
    place.nis = now.nis;
    // What the innovation itself says does not count.
    const Decision d = trusted.decide(now.t_s, now.place.off_m, kPlaceVariance, 0.1, 1.0, &place);
    if (d.loosening == 1.0) continue;
    if (made != nullptr) *made = d;
    return k;
  }
  return -1;
}

/// Fixes each second at 10 m/s, all at one place beside the estimate.
PlaceAt steady_place(int k) {
  PlaceAt out;
  out.t_s = k;
  out.place.off_m = Vector3d(30.0, -20.0, 10.0);
  out.place.speed_m_s = 10.0;
  return out;
}

/// When places that go together make a filter count as lost, in each row that asks: by hand, and at the borders of
/// chi-square that their scatter and drift are judged by, to a hundredth of them.
StressFigure lost_ways() {
  int wrong = 0;
  const auto is = [&](int found, int expected) { wrong += found == expected ? 0 : 1; };
  for (const std::string& row : {std::string("huber"), std::string("student_t"), std::string("innovation_adaptive")}) {
    is(first_found(row, "", steady_place), 8);  // eight seconds, 80 m
    is(first_found(row, "lost_after_s = 12", steady_place), 12);
    is(first_found(row, "lost_after_m = 150", steady_place), 15);
    is(first_found(row, "lost_after_s = 0", steady_place), -1);
    const auto changed = [&](const std::function<void(int, PlaceAt&)>& change) {
      return [change](int k) {
        PlaceAt out = steady_place(k);
        change(k, out);
        return out;
      };
    };
    is(first_found(row, "", changed([](int, PlaceAt& p) { p.place.speed_m_s = 1.0; })), 20);
    is(first_found(row, "", changed([](int, PlaceAt& p) { p.place.speed_m_s = 0.0; })), -1);
    // Speeds between two fixes are the mean of both: 2 m/s and 0 in turn.
    is(first_found(row, "", changed([](int k, PlaceAt& p) { p.place.speed_m_s = k % 2 == 0 ? 2.0 : 0.0; })), 20);
    is(first_found(row, "", changed([](int, PlaceAt& p) { p.t_s *= 4.0; })), 4);  // five at least
    is(first_found(row, "", changed([](int, PlaceAt& p) { p.t_s *= 0.1; })), 80);
    is(first_found(row, "", changed([](int k, PlaceAt& p) { p.nis = k == 5 ? 1.0 : 300.0; })),
       14);  // begun anew after it
    // Its own border: a deviation of five sigma, of three axes.
    const double border = chi_square_threshold(normal_two_sided_tail(5.0), 3.0),
                 other = chi_square_threshold(normal_two_sided_tail(3.0), 3.0);
    is(first_found(row, "", changed([=](int, PlaceAt& p) { p.nis = 0.99 * border; })), -1);
    is(first_found(row, "", changed([=](int, PlaceAt& p) { p.nis = 1.01 * border; })), 8);
    is(first_found(row, "lost_sigma = 3", changed([=](int, PlaceAt& p) { p.nis = 1.01 * other; })), 8);
    is(first_found(row, "lost_sigma = 3", changed([=](int, PlaceAt& p) { p.nis = 0.99 * other; })), -1);
    // Jumps aside after five: those before do not go together with those after, until the stretch is without them.
    is(first_found(row, "", changed([](int k, PlaceAt& p) { p.place.off_m.x() += k < 5 ? 40.0 : 0.0; })), 13);
    // Scatter of nine on an axis, without drift or mean, against chi-square of 24; a drift against that of three.
    const double pattern[] = {1.0, -1.0, -1.0, 1.0, 0.0, 1.0, -1.0, -1.0, 1.0};
    const double scatter = std::sqrt(chi_square_threshold(0.01, 24.0) * kPlaceVariance / 8.0),
                 drift = std::sqrt(chi_square_threshold(0.01, 3.0) * kPlaceVariance / 60.0);
    for (const double part : {0.99, 1.01})
      for (int axis = 0; axis < 3; ++axis) {
        is(first_found(row, "", changed([=](int k, PlaceAt& p) {
                         p.place.off_m[axis] += k < 9 ? part * scatter * pattern[k] : 1e3 * k * k;
                       })),
           part < 1.0 ? 8 : -1);
        is(first_found(row, "", changed([=](int k, PlaceAt& p) {
                         p.place.off_m[axis] += k < 9 ? part * drift * k : 1e3 * k * k;
                       })),
           part < 1.0 ? 8 : -1);
      }
    // A place that leaves at the speed that is measured with it stays with its own motion, and without does not.
    for (const bool measured : {true, false})
      is(first_found(row, "", changed([=](int k, PlaceAt& p) {
                       p.place.leaving_m_s = Vector3d(3.0, -1.0, 0.0) + 0.4 * k * Vector3d(0.0, 1.0, 0.5);
                       p.place.off_m += k * Vector3d(3.0, -1.0, 0.0) + 0.2 * k * k * Vector3d(0.0, 1.0, 0.5);
                       p.place.velocity_measured = measured;
                     })),
         measured ? 8 : -1);
    // What these fixes have moved of the estimate is put back; what others have, where a velocity is measured.
    is(first_found(row, "", changed([](int k, PlaceAt& p) {
                     p.place.off_m -= 3.0 * k * Vector3d(1.0, 0.0, -1.0);
                     p.moved_by_this = k > 0 ? Vector3d(3.0, 0.0, -3.0) : Vector3d(Vector3d::Zero());
                   })),
       8);
    for (const bool measured : {true, false})
      is(first_found(row, "", changed([=](int k, PlaceAt& p) {
                       p.place.off_m -= 3.0 * k * Vector3d(1.0, 0.0, -1.0);
                       p.moved_by_others = k > 0 ? Vector3d(3.0, 0.0, -3.0) : Vector3d(Vector3d::Zero());
                       p.place.velocity_measured = measured;
                     })),
         measured ? 8 : -1);
    // Nothing beside: never.
    Trusted blind(row);
    for (int k = 0; k < 50; ++k)
      wrong += blind.decide(k, Vector3d(30.0, -20.0, 10.0), kPlaceVariance, 0.1, 300.0).loosening == 1.0 ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

/// By how much less sure it then is: the square per axis of this innovation, its speed's difference and what nine fixes
/// over eight seconds can tell of a drift; the noise as it is. Roundings.
StressFigure recovered() {
  Looks looks;
  for (const std::string& row : {std::string("huber"), std::string("student_t"), std::string("innovation_adaptive")}) {
    Decision made;
    first_found(
        row, "",
        [](int k) {
          PlaceAt out = steady_place(k);
          out.nis = 300.0 + k;
          return out;
        },
        &made);
    looks.close(made.loosening, 308.0 / 3.0, 8.0),
        looks.close(made.loosening_m_s, std::sqrt(kPlaceVariance / 60.0), 64.0);
    looks.right(made.accepted && made.noise_scale == 1.0);
    first_found(
        row, "",
        [](int k) {
          PlaceAt out = steady_place(k);
          out.place.leaving_m_s = Vector3d(0.0, 0.0, 1.2), out.place.velocity_measured = true;
          out.place.off_m += 1.2 * k * Vector3d(0.0, 0.0, 1.0);
          return out;
        },
        &made);
    looks.close(made.loosening_m_s, std::sqrt(1.44 / 3.0 + kPlaceVariance / 60.0), 256.0);
  }
  return looks.figure();
}

/// Weights, gates and memories with the settings that stand where nobody gives any, and fuzzy rules where they overlap:
/// degrees by hand, of one innovation, of two that cancel, and of one that fades.
StressFigure rules() {
  Looks looks;
  // Of so many sigma each way, beside a prediction that is as unsure as the noise.
  const auto once = [](const std::string& row, const std::string& keys, double sigmas) {
    return Trusted(row, keys)
        .decide(0.0, Vector3d::Constant(2.0 * sigmas * std::sqrt(2.0)), 4.0, 4.0, 3.0 * sigmas * sigmas)
        .noise_scale;
  };
  looks.close(once("huber", "", 2.69), 2.0, 16.0), looks.close(once("student_t", "", 3.0), 31.0 / 7.0, 16.0);
  looks.right(once("huber", "", 1.3) == 1.0 && once("accept_all", "", 100.0) == 1.0);
  for (const double large : {5.0, 9.0}) {
    const std::string keys = large == 5.0 ? "" : "fuzzy_large = 9";
    const double root = std::sqrt(large);
    const auto factor = [&](double x) { return std::sqrt(once("fuzzy_adaptive", keys, 1.0 + x)); };
    looks.close(factor(0.5), (1.0 + 3.0 * root) / 4.0, 64.0);  // half none, half small
    looks.close(factor(0.2), (0.8 + 0.2 * 3.0 * root) / 1.4, 64.0), looks.close(factor(1.0), root, 64.0);
    looks.close(factor(1.5), (0.75 * root + 3.0 * 0.25 * large) / 1.5, 64.0),
        looks.close(factor(2.0), (root + 3.0 * large) / 4.0, 64.0);
    looks.close(factor(2.6), (0.2 * (root + 2.0 * large) + 0.8 * large) / 1.4, 64.0),
        looks.close(factor(3.0), large, 64.0), looks.close(factor(50.0), large, 64.0);
    // One and its opposite at once: their mean is none, their size what it is.
    Trusted both("fuzzy_adaptive", keys);
    const double s = 1.5;
    both.decide(0.0, Vector3d::Constant(2.0 * s * std::sqrt(2.0)), 4.0, 4.0, 3.0 * s * s);
    looks.close(both.decide(0.0, Vector3d::Constant(-2.0 * s * std::sqrt(2.0)), 4.0, 4.0, 3.0 * s * s).noise_scale,
                std::pow(0.5 + 0.5 * root, 2), 64.0);
    // Then nothing, after the time of its memory: e^-1 of it is left.
    Trusted fading("fuzzy_adaptive", keys + (large == 5.0 ? "" : "\nfuzzy_tau_s = 3"));
    const double first = 4.5, left = std::exp(-1.0), weight = 1.0 + left;
    fading.decide(0.0, Vector3d::Constant(2.0 * first * std::sqrt(2.0)), 4.0, 4.0, 3.0 * first * first);
    const double found =
        std::sqrt(fading.decide(large == 5.0 ? 10.0 : 3.0, Vector3d::Zero(), 4.0, 4.0, 0.0).noise_scale);
    const double mean = left * first / weight - 1.0 / std::sqrt(weight),
                 size = std::sqrt(left * first * first / weight) - 1.0;
    // Here between none and small, there between small and large.
    looks.right(mean > 0.1 && mean < 0.9 && size > 1.1 && size < 2.9);
    const double none = 1.0 - mean, small = mean, s_small = 0.5 * (3.0 - size), s_large = 0.5 * (size - 1.0);
    const auto least = [](double a, double b) { return a < b ? a : b; };
    const double up[] = {least(none, s_small), least(none, s_large), least(small, s_small), least(small, s_large)};
    looks.close(found, ((up[0] + up[2]) * root + (up[1] + up[3]) * large) / (up[0] + up[1] + up[2] + up[3]), 256.0);
    fading.decide(1e6, Vector3d::Zero(), 4.0, 4.0, 0.0);
    (*fading).start();
    looks.close(fading.decide(0.0, Vector3d::Constant(2.0 * 2.0 * std::sqrt(2.0)), 4.0, 4.0, 12.0).noise_scale, large,
                64.0);
  }
  Trusted adaptive("innovation_adaptive");
  adaptive.decide(0.0, Vector3d::Constant(20.0), 4.0, 4.0, 150.0);
  looks.close(adaptive.decide(10.0, Vector3d::Constant(20.0), 4.0, 4.0, 150.0).noise_scale, 99.0, 32.0);
  looks.close(adaptive.decide(20.0, Vector3d::Zero(), 4.0, 4.0, 0.0).noise_scale,
              (99.0 * (std::exp(-1.0) + std::exp(-2.0)) - 1.0) / (1.0 + std::exp(-1.0) + std::exp(-2.0)), 64.0);
  (*adaptive).start();
  looks.close(adaptive.decide(20.1, Vector3d::Constant(10.0), 4.0, 4.0, 37.5).noise_scale, 24.0, 16.0);
  Trusted gate("gate", "gate_sigma = 3");
  int taken = -1;
  for (int k = 0; k < 40 && taken < 0; ++k)
    if (gate.decide(0.7 * k, Vector3d::Constant(100.0), 4.0, 4.0, 1e4).accepted) taken = k;
  looks.right(taken == 15);  // ten seconds after the first
  return looks.figure();
}

}  // namespace

std::vector<StressCase> trust_cases() {
  StressRows rows;
  rows.of({StressGroup::kLong, "a filter that has lost its way",
           "a way by the speed at one end, what others moved counted twice, a border of other degrees",
           "the number of the fix that tells, by hand and at chi-square's borders: exact", "wrong"});
  rows.add("trust/lost_ways", lost_ways);
  rows.of({StressGroup::kData, "what is made of innovations", "a rule of another degree, a memory by samples",
           "closed forms: roundings", "of the bound"});
  rows.add("trust/recovered", recovered).add("trust/rules", rules);
  return rows.take();
}

}  // namespace canyon::fusion
