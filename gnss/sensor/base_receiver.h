#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include "canyon/core/earth/local_frame.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/gnss/sensor/pseudorange_parts.h"
#include "canyon/gnss/sensor/satellites_in_view.h"
#include "canyon/gnss/sensor/signal_tracker.h"
#include "canyon/gnss/single_point/base_station.h"

namespace canyon::gnss {

/// A receiver at a known place in open sky, which sends what its ranges are off:
///
///   difference = pseudorange, smoothed by its carrier + satellite clock - standard troposphere - distance - its clock.
///
/// Satellites, delays, and errors of orbits and clocks are the rover's own models with the rover's seed, looked at from
/// the base. Noise, locks and clock are of its own receiver, by a seed derived from the rover's. Its epochs stand every
/// 1 / base_rate_hz, from before the start on. The code is smoothed by a running mean over the last smoothing_s, all of
/// which are measured where they have not been: it has been running for long whenever it is asked. So what it sends of
/// an epoch is the same alone or in a sequence, but for roundings of the carrier's ambiguities, and for a satellite
/// that its receiver has lost, or that rose, within that time.
///
/// It has one frequency, and neither echoes nor anything that hides the sky above its own mask.
class BaseReceiver {
 public:
  /// Its receiver's figures; an Error where there is no such receiver, or it could not be a base to that rover.
  static Result<GnssConfig> configuration(const GnssConfig& rover, const BaseStationParameters& p);
  /// How long before the start its models must know the world.
  static double lead_s(const GnssConfig& configuration, const BaseStationParameters& p);

  /// `config` by configuration(); the models that `rover` points to must outlive it. `at.start` is lead_s() before the
  /// rover's.
  static Result<std::unique_ptr<BaseReceiver>> make(const SensorSetup& at, const GnssConfig& config,
                                                    const BaseStationParameters& p, const PseudorangeParts& rover);

  /// Forgets what it has measured: it is measured again when it is asked for.
  void restart() { epoch_ = -1; }

  /// What it sent at one epoch.
  struct Sent {
    GpsTime t;
    BaseDifferences::Epoch differences;
    std::map<SatelliteId, RangeDelays> acting;  ///< truth: in the differences; of the troposphere what the model left
  };
  /// The newest that has arrived by t; null: nothing has been sent so early.
  const Sent* arrived(GpsTime t);

  /// Nothing if it sent nothing of the satellite's signal in that band.
  std::optional<BaseCorrection> correction(const Sent& sent, SatelliteId sv, int band,
                                           const Eigen::Vector3d& rover_E) const;

 private:
  /// Code and phase of one satellite, and what a difference is made of.
  struct Range {
    double code_m, phase_m;
    bool slipped;
    int band;
    double less_m;  ///< what is taken from the code, but the clock
    double elevation_rad;
    RangeDelays acting;
  };
  using Ranges = std::map<SatelliteId, Range>;

  BaseReceiver(const SensorSetup& at, const GnssConfig& config, const BaseStationParameters& p,
               const PseudorangeParts& rover);
  GpsTime time(std::int64_t epoch) const { return first_ + static_cast<double>(epoch) / p_.rate_hz; }
  Ranges measure(std::int64_t epoch);
  std::optional<Range> observe(const ReceivingAntenna& antenna, const Sight& sight, GpsTime t, GpsTime receiver_t);
  double smoothed_m(SatelliteId sv) const;
  void send(std::int64_t epoch);

  GnssConfig config_;
  BaseStationParameters p_;
  LocalFrame frame_;
  GpsTime first_;
  Eigen::Vector3d p_E_;
  Horizon horizon_;
  std::shared_ptr<const Constellation> constellation_;
  const IonosphereModel& ionosphere_;
  const TroposphereModel& troposphere_;
  const EphemerisError& ephemeris_error_;
  PseudorangeParts own_;  ///< what tracks; nothing of the world
  SatellitesInView in_view_;
  std::optional<SignalTracker> tracker_;
  std::int64_t window_;        ///< epochs of the running mean
  std::deque<Ranges> ranges_;  ///< of the last epochs, up to the one that was sent
  std::int64_t epoch_ = -1;
  Sent sent_;
};

}  // namespace canyon::gnss
