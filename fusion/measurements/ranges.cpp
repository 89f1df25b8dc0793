#include <algorithm>
#include <cmath>
#include <vector>

#include "canyon/fusion/measurements/body_motion.h"
#include "canyon/fusion/measurements/fix_age.h"
#include "canyon/fusion/states/receiver_clock.h"

namespace canyon::fusion {
namespace {

struct RangesParameters {
  double range_sigma_scale = 1.0;
  double range_rate_sigma_m_s = 0.1;
};
void visit(FieldVisitor& f, RangesParameters& p) {
  f.number("range_sigma_scale", p.range_sigma_scale, {0.01, 1000},
           "factor on the 1-sigma that the receiver assumes of a pseudorange");
  f.number("range_rate_sigma_m_s", p.range_rate_sigma_m_s, {1e-4, 100}, "1-sigma of the rate of a pseudorange");
}

/// Pseudoranges and their rates, as the receiver has corrected them, one by one and each judged by itself: what one
/// satellite tells that is wrong does not spoil the others, and one satellite alone still tells something. Rates leave
/// out what the Earth turns during the signal's travel (5 mm/s).
class Ranges final : public Copied<MeasurementModel, Ranges> {
 public:
  Ranges(const RangesParameters& p, const ErrorState& state)
      : p_(p), age_(state), clock_(state.offset("receiver_clock")) {
    CANYON_CHECK(clock_ >= 0, "measurement \"ranges\" without state \"receiver_clock\"");
  }

  void start() override {
    set_ = false;
    steered_m_ = 0.0;
  }

  int parts(const FilterView& filter, const AidingMessage& message) override {
    const auto* epoch = std::get_if<GnssEpoch>(&message);
    if (epoch == nullptr) return 0;
    steer(filter, *epoch);
    return 2 * static_cast<int>(epoch->observations.size());
  }

  std::optional<Measurement> received(const FilterView& filter, const AidingMessage& message, int part) override {
    const auto* epoch = std::get_if<GnssEpoch>(&message);
    if (epoch == nullptr) return {};
    const GnssObservation& o = epoch->observations[static_cast<std::size_t>(part / 2)];
    const double age_s = age_.of(filter, epoch->t);
    return part % 2 == 0 ? range(filter, o, age_s) : rate(filter, o, age_s);
  }

 private:
  /// Receivers let their clock run and set it back by a millisecond at a time: what so many satellites share is taken
  /// out before the states see it.
  void steer(const FilterView& filter, const GnssEpoch& epoch) {
    const Eigen::Vector3d p_E = antenna_place(filter).p_E;
    std::vector<double> off_m;
    for (const GnssObservation& o : epoch.observations) {
      if (!std::isfinite(o.corrected_m()) || !o.p_E.allFinite()) continue;
      off_m.push_back(o.corrected_m() - steered_m_ - (o.p_E - p_E).norm() - bias_m(filter, o.sv.system));
    }
    if (off_m.empty()) return;
    const auto middle = off_m.begin() + static_cast<std::ptrdiff_t>(off_m.size() / 2);
    std::nth_element(off_m.begin(), middle, off_m.end());
    if (!set_ || std::abs(*middle) > kJump_m) steered_m_ += *middle;
    set_ = true;
  }

  /// What this system's pseudoranges are longer by, beside what has been steered.
  double bias_m(const FilterView& filter, GnssSystem system) const {
    const Eigen::VectorXd clock = filter.state.values(clock_, ClockIndex::kSize);
    const int own = ClockIndex::of(system);
    return clock[ClockIndex::kClock] + (own < 0 ? 0.0 : clock[own]);
  }

  std::optional<Measurement> range(const FilterView& filter, const GnssObservation& o, double age_s) const {
    if (!std::isfinite(o.corrected_m()) || !o.p_E.allFinite() || !(o.sigma_m > 0.0)) return {};
    const PointPlace antenna = antenna_place(filter);
    const PointVelocity moving = antenna_velocity(filter);
    const Eigen::Vector3d to_E = o.p_E - (antenna.p_E + age_s * moving.v_E);
    const Eigen::RowVector3d u = to_E.normalized().transpose();
    Measurement m(1, filter.state, ErrorIndex::kPosition);
    m.residual[0] = o.corrected_m() - steered_m_ - to_E.norm() - bias_m(filter, o.sv.system);
    m.H = -u * (antenna.H + age_s * moving.H);
    age_.set_column(m.H, -u * moving.v_E);
    m.H(0, clock_ + ClockIndex::kClock) = 1.0;
    if (const int own = ClockIndex::of(o.sv.system); own >= 0) m.H(0, clock_ + own) = 1.0;
    m.R(0, 0) = std::pow(p_.range_sigma_scale * o.sigma_m, 2);
    return m;
  }

  std::optional<Measurement> rate(const FilterView& filter, const GnssObservation& o, double age_s) const {
    if (!std::isfinite(o.rate_m_s) || !o.p_E.allFinite() || !o.v_E.allFinite()) return {};
    const PointPlace antenna = antenna_place(filter);
    const PointVelocity moving = antenna_velocity(filter);
    const Eigen::Vector3d to_E = o.p_E - (antenna.p_E + age_s * moving.v_E), v_E = o.v_E - moving.v_E;
    const double distance_m = to_E.norm();
    const Eigen::Vector3d u = to_E / distance_m;
    const Eigen::RowVector3d by_place = (u * u.dot(v_E) - v_E).transpose() / distance_m;
    Measurement m(1, filter.state, ErrorIndex::kVelocity);
    m.residual[0] = o.rate_m_s - u.dot(v_E) - filter.state.values(clock_, ClockIndex::kSize)[ClockIndex::kRate];
    m.H = by_place * (antenna.H + age_s * moving.H) - u.transpose() * moving.H;
    age_.set_column(m.H, by_place * moving.v_E);
    m.H(0, clock_ + ClockIndex::kRate) = 1.0;
    m.R(0, 0) = p_.range_rate_sigma_m_s * p_.range_rate_sigma_m_s;
    return m;
  }

  static constexpr double kJump_m = 3000.0;  // 10 microseconds

  RangesParameters p_;
  FixAge age_;
  int clock_;
  bool set_ = false;
  double steered_m_ = 0.0;
};

}  // namespace

std::unique_ptr<MeasurementModel> make_ranges(const ModelParameters& own, const MeasurementSetup& at) {
  return std::make_unique<Ranges>(own.get<RangesParameters>(), at.state);
}

void ranges_parameters(ModelParameters& section) {
  section.add<RangesParameters>();
}

}  // namespace canyon::fusion
