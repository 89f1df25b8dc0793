#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/gnss/atmosphere/klobuchar.h"
#include "canyon/gnss/products/ionex_file.h"
#include "canyon/gnss/rinex/observation/observation_file.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/satellites/navigation_data.h"
#include "canyon/gnss/single_point/base_station.h"
#include "canyon/gnss/single_point/code_choice.h"
#include "canyon/gnss/single_point/config.h"
#include "canyon/gnss/single_point/group_delay.h"
#include "canyon/gnss/single_point/range_corrections.h"
#include "canyon/gnss/single_point/satellite_warnings.h"
#include "canyon/gnss/sky_view.h"
#include "canyon/gnss/solver/carrier_smoothing.h"
#include "canyon/gnss/solver/position_solver.h"
#include "canyon/gnss/solver/weighting.h"

namespace canyon::gnss {

/// What the observations are solved with.
struct SinglePointInputs {
  const Constellation& constellation;
  const NavigationData& navigation;            ///< for its ionosphere coefficients and its names in messages
  const IonexMaps* ionosphere_maps = nullptr;  ///< needed where config.ionosphere is "ionex"
  /// Positions are differential then: ranges are corrected by what the base's, smoothed as configured, are off, beside
  /// what the models differ by between the two places; satellites that the base does not have are not used.
  const BaseRecording* base = nullptr;
};

/// One satellite of an epoch on its way to a range.
struct ObservedRange {
  SatelliteId sv;
  CodeMeasurement code;
  SignalObservation signal;
  SatelliteState state;  // at transmission, in E of transmission
  double group_delay_s = 0.0;
  double group_delay_sigma_m = 0.0;
  bool loss_of_lock = false;
  BroadcastKlobuchar klobuchar;
  double base_m = 0.0, base_sigma_m = 0.0;  // what the base's range is off, and how uncertain that is
};

/// Makes ranges of the observations of one file, epoch after epoch, as configured.
class RangeObserver {
 public:
  /// The observations, inputs and config must outlive it. `differential`: what the models leave is the base's to tell,
  /// so a range's uncertainty is that of two receivers near one another.
  RangeObserver(const ObservationFile& file, const SinglePointInputs& inputs, const SinglePointConfig& config,
                bool differential);

  /// The satellites of config.systems whose ephemeris is valid at that time.
  std::vector<ObservedRange> usable(const ObservationEpoch& epoch);

  /// By the carrier, config.smoothing_s. Epochs in order of time.
  void smooth(std::vector<ObservedRange>& candidates, const ObservationEpoch& epoch, const Eigen::Vector3d& at_E);

  /// The ranges of those above the mask as seen from at_E, corrected by the models and the base, and the observations
  /// that they were made of, in the same order.
  void correct(const std::vector<ObservedRange>& candidates, GpsTime t, const Eigen::Vector3d& at_E, GnssEpoch& epoch,
               std::vector<RangeMeasurement>& ranges) const;

  /// Satellites that were observed but are not used, or with something missing: `file:line: what`.
  std::vector<std::string> warnings() const;

  /// Errors: until now no system of config.systems was observed, or no satellite with an ephemeris.
  Status anything_usable() const;

 private:
  bool uses_klobuchar() const;
  BroadcastKlobuchar coefficients(GnssSystem system, GpsTime t) const;
  double ionosphere_m(const ObservedRange& c, const SkyView& view) const;

  const ObservationFile& file_;
  const SinglePointInputs& inputs_;
  const SinglePointConfig& config_;
  bool differential_;
  std::unique_ptr<RangeWeighting> weighting_;
  TroposphereCorrection* troposphere_m_;
  GroupDelays group_delays_;
  CarrierSmoothing smoothing_;
  MissingEphemerides missing_;
  Shortcomings without_channel_, lent_delay_;
  std::int64_t observed_ = 0, with_ephemeris_ = 0;
};

/// What the ranges that a base at p_E observed are off, its clock taken out.
BaseDifferences base_differences(RangeObserver& base, const ObservationFile& observed, const Eigen::Vector3d& p_E);

}  // namespace canyon::gnss
