#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "canyon/core/messages.h"
#include "canyon/core/model_table.h"
#include "canyon/gnss/atmosphere/ionosphere.h"
#include "canyon/gnss/atmosphere/troposphere.h"
#include "canyon/gnss/receiver/modes/delay_omissions.h"

namespace canyon::gnss {

/// The delays that act on a range beside geometry, clocks, multipath and noise; m.
struct RangeDelays {
  double ionosphere_m = 0.0;
  double troposphere_m = 0.0;
  double ephemeris_m = 0.0;
};

/// What the receiver subtracts. `base_m` is the base station's own error, which comes with a differential correction;
/// `noise_m` and `multipath_m` are what two frequencies' own errors bring into their difference.
struct Correction {
  RangeDelays modelled;
  double base_m = 0.0;
  double noise_m = 0.0, multipath_m = 0.0;
  double smoothing_m = 0.0;  ///< raw range less smoothed one; of the combination, where two frequencies are combined
  double total_m() const {
    const double errors_m = modelled.ionosphere_m + modelled.troposphere_m + modelled.ephemeris_m;
    return errors_m + base_m + noise_m + multipath_m + smoothing_m;
  }
};

/// Second frequency minus first.
struct FrequencyDifference {
  double gain = 0.0;         ///< 1 / ((f1 / f2)^2 - 1): first frequency's ionospheric delay per metre of difference
  double measured_m = 0.0;   ///< of the pseudoranges, satellite clocks applied: this is all that a receiver knows
  double noise_m = 0.0;      ///< of that, what is thermal noise,
  double multipath_m = 0.0;  ///< and what is multipath
};

/// What a base tells of one satellite, and how it came about.
struct BaseCorrection {
  double m = 0.0;            ///< what the base's range was off, beside the modelled troposphere and its clock
  double sigma_m = 0.0;      ///< of its code
  double distance_km = 0.0;  ///< from the rover's antenna
  RangeDelays acting;        ///< of m, what acted on the base's range; of the troposphere what the model left
};

/// One satellite at one epoch, for the mode.
struct CorrectionInput {
  SatelliteId sv;
  GpsTime t;
  SkyView true_view;       ///< where the satellite really stands
  SkyView receivers_view;  ///< where the receiver believes it to stand
  double range_m = 0.0;
  RangeDelays acting;                      ///< what acts on the rover's range, at its own carrier
  double ionosphere_from_l1 = 1.0;         ///< delay there per delay at L1: (L1 / carrier)^2
  std::optional<FrequencyDifference> two;  ///< none: only the first signal is tracked
  DelayOmissions leave_out{};
  std::optional<BaseCorrection> base{};  ///< none: there is no base, or it tells nothing of the satellite
};

struct BaseStationParameters;

/// Mode of operation: which errors act on the range, and which of them the receiver removes.
class ReceiverMode {
 public:
  virtual ~ReceiverMode() = default;
  /// The part of the raw delays that acts on the range at all; all of it, but for dgps_paper.
  virtual RangeDelays acting(const RangeDelays& raw) const { return raw; }
  virtual Correction correction(const CorrectionInput& in) const = 0;
  /// How many models a correction asks beside those of the delays that act.
  virtual int asks(const DelayOmissions&) const { return 0; }
  virtual FixStatus status() const = 0;
  virtual bool dual_frequency() const { return false; }
  /// The base without whose corrections a range is not used; null: none is needed.
  virtual const BaseStationParameters* base() const { return nullptr; }
  /// Does it correct for the atmosphere, so that a residual is left, or do the raw delays act?
  virtual bool corrects_atmosphere() const = 0;
};

/// What modes are built from beside their own keys.
struct ReceiverModeSetup {
  std::uint64_t seed = 0;
  bool ionosphere = true;  ///< that effect is switched on: only then is it corrected, or does it leave a residual
  bool troposphere = true;
  KlobucharCoefficients klobuchar{};
};

using MakeReceiverMode =
    MakerAndNeed<std::unique_ptr<ReceiverMode>(const ModelParameters& own, const ReceiverModeSetup& at),
                 StateDelayNeeds>;
ModelTable<MakeReceiverMode> receiver_modes();

/// Key of what is subtracted for the ionosphere with one frequency: in mode single, and in mode dual for a satellite
/// whose second signal is lost.
struct SingleFrequencyParameters {
  enum class Ionosphere { kNone, kHalf, kKlobuchar };
  Ionosphere ionosphere_correction = Ionosphere::kHalf;
};
void visit(FieldVisitor& f, SingleFrequencyParameters& c);
/// What that correction subtracts, m.
double modelled_ionosphere_m(SingleFrequencyParameters::Ionosphere correction, const ReceiverModeSetup& at,
                             const CorrectionInput& in);

/// Keys of mode dgps. Mode dgps_base takes the gradients and the scale.
struct DgpsParameters {
  double baseline_km = 5.0;                     ///< distance of the base station
  double ionosphere_gradient_mm_per_km = 2.0;   ///< 1-sigma of the vertical delay's difference to the base
  double troposphere_gradient_mm_per_km = 1.0;  ///< the same for the zenith wet delay
  double base_error_scale = 1.0;                ///< base station's own code noise and multipath, 1 = GAD-B
};
void visit(FieldVisitor& f, DgpsParameters& c);

/// Keys of mode dgps_base beside those.
struct BaseStationParameters {
  Eigen::Vector3d place_m{-3000.0, 4000.0, 20.0};  ///< of its antenna, in W
  std::string receiver = "survey_multi";           ///< a receiver of the catalogue, or a file
  double rate_hz = 1.0;
  double latency_s = 1.0;  ///< from the base's measuring to the rover's use
  double age_s = 30.0;     ///< older corrections are not used
};
void visit(FieldVisitor& f, BaseStationParameters& c);

std::unique_ptr<ReceiverMode> make_single(const ModelParameters& own, const ReceiverModeSetup& at);
std::unique_ptr<ReceiverMode> make_dual(const ModelParameters& own, const ReceiverModeSetup& at);
std::unique_ptr<ReceiverMode> make_dgps(const ModelParameters& own, const ReceiverModeSetup& at);
std::unique_ptr<ReceiverMode> make_base(const ModelParameters& own, const ReceiverModeSetup& at);
StateDelayNeeds dgps_needs;

}  // namespace canyon::gnss
