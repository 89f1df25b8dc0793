#include "canyon/gnss/sensor/base_receiver.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/gnss/antenna_height.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/sensor/receiver_catalogue.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/solver/gauss_newton.h"
#include "canyon/gnss/solver/velocity.h"
#include "canyon/scene/scene.h"

namespace canyon::gnss {
namespace {

constexpr double kLowestModelledRad = 5.0 * kDegree;  // as the rover holds the models of its corrections

/// Of all that the base draws by itself.
std::uint64_t of_base(std::uint64_t seed) {
  return RandomStream(seed, "gnss.base").key();
}

bool tracks(const GnssConfig& config, GnssSystem system) {
  return config.satellites.systems.find(system_letter(system)) != std::string::npos;
}

bool have_common_system(const GnssConfig& a, const GnssConfig& b) {
  const std::string& systems = a.satellites.systems;
  return std::any_of(systems.begin(), systems.end(),
                     [&](char c) { return b.satellites.systems.find(c) != std::string::npos; });
}

}  // namespace

Result<GnssConfig> BaseReceiver::configuration(const GnssConfig& rover, const BaseStationParameters& p) {
  constexpr const char* kKey = "gnss.base_receiver";
  const auto sheet = load_receiver(p.receiver);
  if (!sheet) {
    Error error = sheet.error();
    if (error.file.empty()) error.key = kKey;
    return error;
  }
  GnssConfig base;
  CANYON_TRY_STATUS(read_config(&sheet->figures, "", base));
  if (base.mode.name.starts_with("dgps"))
    return Error{"", 0, kKey, "receiver \"" + p.receiver + "\" needs a base itself, mode = \"" + base.mode.name + "\"",
                 "a receiver that stands alone"};
  if (!have_common_system(rover, base))
    return Error{
        "", 0, kKey,
        "receiver \"" + p.receiver + "\" tracks " + base.satellites.systems + ", the rover " + rover.satellites.systems,
        "a system that both track"};
  base.rate_hz = p.rate_hz;
  base.reception = rover.reception;
  base.link.antenna_phase_centre = rover.link.antenna_phase_centre;
  base.tracking.thermal_noise_scale = rover.mode.own.get<DgpsParameters>().base_error_scale;
  return base;
}

double BaseReceiver::lead_s(const GnssConfig& configuration, const BaseStationParameters& p) {
  return p.latency_s + configuration.position.smoothing_s + 2.0 / p.rate_hz;
}

Result<std::unique_ptr<BaseReceiver>> BaseReceiver::make(const SensorSetup& at, const GnssConfig& config,
                                                         const BaseStationParameters& p,
                                                         const PseudorangeParts& rover) {
  CANYON_TRY_STATUS(check_antenna_height(at.scene.frame().to_E(p.place_m), {.key = "gnss.base_place_m"}));
  std::unique_ptr<BaseReceiver> out(new BaseReceiver(at, config, p, rover));
  CANYON_TRY_STATUS(add_tracking(config, of_base(at.seed), of_base(at.noise_seed), out->own_));
  out->tracker_.emplace("gnss.", out->config_, out->own_);
  return out;
}

BaseReceiver::BaseReceiver(const SensorSetup& at, const GnssConfig& config, const BaseStationParameters& p,
                           const PseudorangeParts& rover)
    : config_(config),
      p_(p),
      frame_(at.scene.frame()),
      first_(at.start),
      p_E_(frame_.to_E(p.place_m)),
      horizon_(p_E_),
      constellation_(rover.constellation),
      ionosphere_(*rover.ionosphere),
      troposphere_(*rover.troposphere),
      ephemeris_error_(*rover.ephemeris_error),
      in_view_(rover.constellation, frame_, config.mask_deg * kDegree),
      window_(std::max<std::int64_t>(1, std::llround(config.position.smoothing_s * p.rate_hz))) {}

const BaseReceiver::Sent* BaseReceiver::arrived(GpsTime t) {
  constexpr double kRounding = 1e-6;  // of an epoch: times are kept to a nanosecond
  const auto newest = static_cast<std::int64_t>(std::floor((t - first_ - p_.latency_s) * p_.rate_hz + kRounding));
  if (newest < 0) return nullptr;
  if (newest != epoch_) send(newest);
  return &sent_;
}

std::optional<BaseCorrection> BaseReceiver::correction(const Sent& sent, SatelliteId sv, int band,
                                                       const Eigen::Vector3d& rover_E) const {
  const auto of = sent.differences.satellites.find(sv);
  if (of == sent.differences.satellites.end() || of->second.band != band) return std::nullopt;
  return BaseCorrection{of->second.m, base_code_sigma_m(of->second.elevation_rad), 1e-3 * (rover_E - p_E_).norm(),
                        sent.acting.at(sv)};
}

/// Measures what is missing of the last window_ epochs.
void BaseReceiver::send(std::int64_t epoch) {
  const std::int64_t oldest = std::max<std::int64_t>(0, epoch - window_ + 1);
  std::int64_t next = epoch_ + 1;
  if (epoch < next || next < oldest || epoch_ < 0) {
    ranges_.clear();
    tracker_->restart();
    next = oldest;
  }
  for (; next <= epoch; ++next) ranges_.push_back(measure(next));
  while (ranges_.size() > static_cast<std::size_t>(epoch - oldest + 1)) ranges_.pop_front();
  epoch_ = epoch;
  sent_ = {time(epoch), {time(epoch), {}}, {}};
  for (const auto& [sv, range] : ranges_.back()) {
    sent_.differences.satellites[sv] = {smoothed_m(sv) - range.less_m, range.band, range.elevation_rad};
    sent_.acting[sv] = range.acting;
  }
  take_out_clock(sent_.differences);
}

BaseReceiver::Ranges BaseReceiver::measure(std::int64_t epoch) {
  const GpsTime t = time(epoch);
  tracker_->begin_epoch(epoch);
  const ReceivingAntenna antenna{epoch, frame_.R_EW().transpose() * horizon_.R_E_enu().col(2), Eigen::Vector3d::Zero(),
                                 own_.clock->offset_m(epoch), own_.clock->rate_m_s(epoch)};
  const GpsTime receiver_t = t + antenna.clock_m / kSpeedOfLight;
  Ranges out;
  for (const Sight& sight : in_view_.at(t, receiver_t, p_E_, horizon_)) {
    if (!tracks(config_, sight.sv.system)) continue;
    if (const auto range = observe(antenna, sight, t, receiver_t)) out.emplace(sight.sv, *range);
  }
  return out;
}

std::optional<BaseReceiver::Range> BaseReceiver::observe(const ReceivingAntenna& antenna, const Sight& sight, GpsTime t,
                                                         GpsTime receiver_t) {
  const int band = first_band(sight.sv.system);
  const double from_l1 = kL1Hz / sight.carrier_hz(band);
  RangeDelays acting;
  acting.ionosphere_m = from_l1 * from_l1 * ionosphere_.delay_m(sight.view);
  acting.troposphere_m = troposphere_.delay_m(sight.view);
  acting.ephemeris_m = ephemeris_error_.range_m(sight.sv, sight.signal.state, p_E_, t);
  const double phase_centre_m =
      config_.link.antenna_phase_centre
          ? own_.link.antenna->phase_centre_m(horizon_.R_E_enu().transpose() * (frame_.R_EW() * sight.direction_W))
          : 0.0;
  const SatelliteState& satellite = sight.signal.state;
  const double rate_m_s = range_rate_m_s({.p_E = satellite.p_E, .v_E = satellite.v_E}, p_E_, Eigen::Vector3d::Zero());
  const SignalMeasurement m =
      tracker_->measure(antenna, sight, SignalPaths{}, band, {rate_m_s, acting, phase_centre_m});
  if (!m.tracked) return std::nullopt;

  // From here on what the base itself knows.
  const auto told = transmission_from_pseudorange(*constellation_, sight.sv, receiver_t, m.pseudorange_m);
  if (!told) return std::nullopt;
  const double light_s = (told->state.p_E - p_E_).norm() / kSpeedOfLight;
  const Eigen::Vector3d satellite_E = turned_by_earth(told->state.p_E, light_s);
  SkyView view = horizon_.view(receiver_t, satellite_E);
  const double elevation_rad = view.elevation_rad;
  view.elevation_rad = std::max(view.elevation_rad, kLowestModelledRad);
  const double modelled_m = troposphere_.acts() ? standard_troposphere_m(view) : 0.0;
  acting.troposphere_m -= modelled_m;
  return Range{.code_m = m.pseudorange_m,
               .phase_m = m.carrier_phase_cycles * kSpeedOfLight / sight.carrier_hz(band),
               .slipped = m.slipped,
               .band = band,
               .less_m = line_of_sight(told->state.p_E, p_E_).range_m + modelled_m -
                         kSpeedOfLight * told->state.clock_of_band_s(band),
               .elevation_rad = elevation_rad,
               .acting = acting};
}

/// The code of the last epoch, as the mean over all epochs since lock was lost last has it.
double BaseReceiver::smoothed_m(SatelliteId sv) const {
  std::size_t first = ranges_.size() - 1;
  while (first > 0 && !ranges_[first].at(sv).slipped && ranges_[first - 1].contains(sv)) --first;
  const Range& now = ranges_.back().at(sv);
  const double now_m = now.code_m - now.phase_m;
  double sum_m = 0.0;
  for (std::size_t k = first; k < ranges_.size(); ++k) {
    const Range& then = ranges_[k].at(sv);
    sum_m += then.code_m - then.phase_m - now_m;
  }
  return now.code_m + sum_m / static_cast<double>(ranges_.size() - first);
}

}  // namespace canyon::gnss
