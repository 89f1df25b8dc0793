#include "canyon/study/drive_check/drive_signals.h"

#include <cmath>
#include <map>

#include "canyon/core/math/median.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/klobuchar.h"
#include "canyon/gnss/atmosphere/troposphere.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/single_point/code_choice.h"
#include "canyon/gnss/solver/velocity.h"
#include "canyon/scene/scene_at.h"

namespace canyon::study {
namespace {

constexpr std::size_t kFewestForClock = 2;

/// Errors with the receiver's clock still in them.
class SignalReader {
 public:
  SignalReader(const gnss::ObservationFile& observations, const gnss::Constellation& constellation,
               const gnss::NavigationData& navigation, const gnss::SinglePointConfig& config,
               const DriveStretch& stretch)
      : observations_(observations),
        constellation_(constellation),
        navigation_(navigation),
        config_(config),
        delays_(gnss::GroupDelayModel::kBroadcast, navigation),
        frame_(stretch.scene.frame()),
        scene_(stretch.scene) {}

  DriveEpoch read(const gnss::ObservationEpoch& epoch, const PlacePath::State& truth) const {
    DriveEpoch out{epoch.t, {}};
    const gnss::Horizon horizon(truth.p_E);
    const Eigen::Vector3d p_A_W = frame_.to_W(truth.p_E);
    for (const gnss::SatelliteObservations& one : epoch.satellites) {
      if (config_.systems.find(system_letter(one.sv.system)) == std::string::npos) continue;
      const auto signal = gnss::single_frequency_signal(observations_.codes(epoch, one.sv.system), one);
      if (!signal) continue;
      const auto sent = gnss::transmission_from_pseudorange(constellation_, one.sv, epoch.t, signal->pseudorange_m);
      if (!sent) continue;
      const double hz = gnss::carrier_hz(one.sv.system, signal->code.band - '0', sent->state.frequency_channel);
      if (!std::isfinite(hz)) continue;
      const double travel_s = (sent->state.p_E - truth.p_E).norm() / kSpeedOfLight;
      const Eigen::Vector3d p_E = gnss::turned_by_earth(sent->state.p_E, travel_s);
      const gnss::SkyView view = horizon.view(epoch.t, p_E);
      if (view.elevation_rad < config_.mask_deg * kDegree) continue;
      DriveSignal s{.sv = one.sv,
                    .elevation_rad = view.elevation_rad,
                    .azimuth_rad = view.azimuth_rad,
                    .cn0_dbhz = signal->cn0_dbhz};
      const Eigen::Vector3d towards_W = frame_.R_EW().transpose() * (p_E - truth.p_E).normalized();
      s.in_sight = !scene_.blocked_towards(p_A_W, towards_W);
      const double clock_s =
          sent->state.clock_s - delays_.delay_s(sent->state, one.sv, signal->code.band - '0', std::nullopt);
      s.error_m = signal->pseudorange_m + kSpeedOfLight * clock_s - (p_E - truth.p_E).norm() - delay_m(view, hz);
      const double geometric_m_s =
          gnss::range_rate_m_s({.p_E = sent->state.p_E, .v_E = sent->state.v_E}, truth.p_E, truth.v_E);
      s.rate_error_m_s =
          gnss::pseudorange_rate_m_s(signal->doppler_hz, hz) + kSpeedOfLight * sent->state.clock_rate - geometric_m_s;
      out.signals.push_back(s);
    }
    return out;
  }

 private:
  double delay_m(const gnss::SkyView& view, double hz) const {
    const auto klobuchar = navigation_.klobuchar_at(GnssSystem::kGps, view.t).value_or(gnss::kBuiltInKlobuchar);
    const double from_l1 = gnss::kL1Hz / hz;
    return from_l1 * from_l1 *
               gnss::klobuchar_delay_m(klobuchar, view.t, view.receiver.lat_rad, view.receiver.lon_rad,
                                       view.azimuth_rad, view.elevation_rad) +
           gnss::standard_troposphere_m(view);
  }

  const gnss::ObservationFile& observations_;
  const gnss::Constellation& constellation_;
  const gnss::NavigationData& navigation_;
  const gnss::SinglePointConfig& config_;
  gnss::GroupDelays delays_;
  const LocalFrame& frame_;
  scene::SceneAt scene_;
};

double median_in_sight(const DriveEpoch& epoch, double DriveSignal::*value, std::optional<GnssSystem> system,
                       std::size_t fewest) {
  std::vector<double> values;
  for (const DriveSignal& s : epoch.signals)
    if (s.in_sight && std::isfinite(s.*value) && (!system || s.sv.system == *system)) values.push_back(s.*value);
  return values.size() < fewest ? kNaN : median(values);
}

/// Of each system's receiver delay, against the system that comes first.
void take_out_system_offsets(std::vector<DriveEpoch>& epochs) {
  std::map<GnssSystem, std::vector<double>> offsets_m;
  std::optional<GnssSystem> first;
  for (const DriveEpoch& epoch : epochs)
    for (const DriveSignal& s : epoch.signals)
      if (!first || s.sv.system < *first) first = s.sv.system;
  if (!first) return;
  for (const DriveEpoch& epoch : epochs) {
    const double base_m = median_in_sight(epoch, &DriveSignal::error_m, first, 1);
    for (const GnssSystem system : gnss::kGnssSystems) {
      const double own_m = median_in_sight(epoch, &DriveSignal::error_m, system, 1);
      if (std::isfinite(own_m) && std::isfinite(base_m)) offsets_m[system].push_back(own_m - base_m);
    }
  }
  for (DriveEpoch& epoch : epochs)
    for (DriveSignal& s : epoch.signals)
      s.error_m -= offsets_m.count(s.sv.system) > 0 ? median(offsets_m[s.sv.system]) : kNaN;
}

void take_out_clock(DriveEpoch& epoch) {
  for (double DriveSignal::*value : {&DriveSignal::error_m, &DriveSignal::rate_error_m_s}) {
    const double clock = median_in_sight(epoch, value, std::nullopt, kFewestForClock);
    for (DriveSignal& s : epoch.signals) s.*value -= clock;
  }
}

}  // namespace

std::vector<DriveEpoch> drive_signals(const gnss::ObservationFile& observations,
                                      const gnss::Constellation& constellation, const gnss::NavigationData& navigation,
                                      const gnss::SinglePointConfig& config, const DriveStretch& stretch) {
  const SignalReader reader(observations, constellation, navigation, config, stretch);
  std::vector<DriveEpoch> out;
  for (const gnss::ObservationEpoch& epoch : observations.epochs) {
    throw_if_cancelled();
    const auto truth = stretch.truth.at(epoch.t);
    if (truth && stretch.holds(epoch.t)) out.push_back(reader.read(epoch, *truth));
  }
  take_out_system_offsets(out);
  for (DriveEpoch& epoch : out) take_out_clock(epoch);
  return out;
}

}  // namespace canyon::study
