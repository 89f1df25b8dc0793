#include <algorithm>
#include <cmath>
#include <vector>

#include "canyon/fusion/measurements/body_motion.h"
#include "canyon/fusion/measurements/fix_age.h"
#include "canyon/fusion/measurements/satellite_slots.h"
#include "canyon/fusion/states/range_errors.h"
#include "canyon/fusion/states/receiver_clock.h"

namespace canyon::fusion {
namespace {

struct RangesParameters {
  double range_sigma_scale = 1.0;
  double range_rate_sigma_m_s = 0.2;
};
void visit(FieldVisitor& f, RangesParameters& p) {
  f.number("range_sigma_scale", p.range_sigma_scale, {0.01, 1000},
           "factor on the 1-sigma that the receiver assumes of a pseudorange");
  f.number("range_rate_sigma_m_s", p.range_rate_sigma_m_s, {1e-4, 100}, "1-sigma of the rate of a pseudorange");
}

/// Pseudoranges and their rates, as the receiver has corrected them, one by one and each judged by itself: what one
/// satellite tells that is wrong does not spoil the others, and one satellite alone still tells something. With the
/// block range_errors, what lasts of each satellite's error is estimated; where there are more satellites than states
/// it counts as noise. Rates leave out what the Earth turns during the signal's travel (5 mm/s).
class Ranges final : public Copied<MeasurementModel, Ranges> {
 public:
  Ranges(const RangesParameters& p, const RangeErrorsParameters& lasting, const ErrorState& state)
      : p_(p),
        lasting_(lasting),
        age_(state),
        clock_(state.offset("receiver_clock")),
        errors_(state.offset("range_errors")),
        slots_(errors_ < 0 ? 0 : static_cast<int>(lasting.range_error_slots)) {
    CANYON_CHECK(clock_ >= 0, "measurement \"ranges\" without state \"receiver_clock\"");
  }

  void start() override {
    set_ = false;
    steered_m_ = 0.0;
    last_ = {};
    slots_.clear();
    renewed_.clear();
  }

  int parts(const FilterView& filter, const AidingMessage& message) override {
    renewed_.clear();
    const auto* epoch = std::get_if<GnssEpoch>(&message);
    if (epoch == nullptr) return 0;
    if (errors_ >= 0) renew(filter, *epoch);
    steer(filter, *epoch);
    return 2 * static_cast<int>(epoch->observations.size());
  }

  std::span<const Renewal> renewed() const override { return renewed_; }

  std::optional<Measurement> received(const FilterView& filter, const AidingMessage& message, int part) override {
    const auto* epoch = std::get_if<GnssEpoch>(&message);
    if (epoch == nullptr) return {};
    const GnssObservation& o = epoch->observations[static_cast<std::size_t>(part / 2)];
    const double age_s = age_.of(filter, epoch->t);
    return part % 2 == 0 ? range(filter, o, age_s) : rate(filter, o, age_s);
  }

 private:
  /// A satellite that comes begins anew; of one that was there the antenna's way has changed the echoes.
  void renew(const FilterView& filter, const GnssEpoch& epoch) {
    const double way_m = last_ ? std::abs(epoch.t - *last_) * antenna_velocity(filter).v_E.norm() : 0.0;
    const double kept = std::exp(-way_m / lasting_.range_error_way_m);
    last_ = epoch.t;
    slots_.assign(epoch);
    for (const int slot : slots_.begun()) renewed_.push_back({errors_ + slot, 0.0});
    if (kept == 1.0) return;
    for (int slot = 0; slot < slots_.count(); ++slot)
      if (slots_.taken(slot)) renewed_.push_back({errors_ + slot, kept});
  }

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
    if (errors_ >= 0) add_lasting(filter, o, u, m);
    return m;
  }

  void add_lasting(const FilterView& filter, const GnssObservation& o, const Eigen::RowVector3d& u,
                   Measurement& m) const {
    const double cn0 = cn0_dbhz(filter, o, u), sigma_m = lasting_.sigma_m(cn0);
    m.residual[0] -= lasting_.mean_m(cn0);
    if (const int slot = slots_.of(o.sv); slot >= 0) {
      m.residual[0] -= sigma_m * filter.state.values(errors_ + slot, 1)[0];
      m.H(0, errors_ + slot) = sigma_m;
    } else {
      m.R(0, 0) += sigma_m * sigma_m;
    }
  }

  /// Where the receiver does not tell it: a patch antenna in the open, which loses some 7 dB from the zenith to the
  /// horizon.
  static double cn0_dbhz(const FilterView& filter, const GnssObservation& o, const Eigen::RowVector3d& u) {
    if (std::isfinite(o.cn0_dbhz)) return o.cn0_dbhz;
    return kClearCn0Dbhz - 7.0 * (1.0 - std::max(u.dot(filter.state.nav.p_EU_E.normalized()), 0.0));
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
    double sigma_m_s = p_.range_rate_sigma_m_s;
    if (errors_ >= 0) sigma_m_s *= lasting_.growth(cn0_dbhz(filter, o, u.transpose()));
    m.R(0, 0) = sigma_m_s * sigma_m_s;
    return m;
  }

  static constexpr double kJump_m = 3000.0;  // 10 microseconds

  RangesParameters p_;
  RangeErrorsParameters lasting_;
  FixAge age_;
  int clock_, errors_;
  SatelliteSlots slots_;
  std::optional<GpsTime> last_;
  std::vector<Renewal> renewed_;
  bool set_ = false;
  double steered_m_ = 0.0;
};

}  // namespace

std::unique_ptr<MeasurementModel> make_ranges(const ModelParameters& own, const MeasurementSetup& at) {
  return std::make_unique<Ranges>(own.get<RangesParameters>(), own.get<RangeErrorsParameters>(), at.state);
}

void ranges_parameters(ModelParameters& section) {
  section.add<RangesParameters>();
}

}  // namespace canyon::fusion
