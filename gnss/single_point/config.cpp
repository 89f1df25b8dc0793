#include "canyon/gnss/single_point/config.h"

#include "canyon/gnss/single_point/range_corrections.h"
#include "canyon/gnss/solver/fault_exclusion.h"
#include "canyon/gnss/solver/weighting.h"

namespace canyon::gnss {
namespace {

constexpr ModelRow<Frequencies> kFrequencies[] = {
    {"single", Frequencies::kSingle, "the first band alone"},
    {"dual", Frequencies::kDual, "ionosphere-free combination of two"},
};
constexpr ModelRow<EphemerisChoice> kEphemerides[] = {
    {"nearest_toe", EphemerisChoice::kNearestToe, "the best orbit of the file"},
    {"transmitted", EphemerisChoice::kTransmitted, "what a receiver had at that time"},
};

}  // namespace

void visit(FieldVisitor& f, SinglePointConfig& c) {
  f.text("systems", c.systems, "satellite systems by their RINEX letters, of G R E C J");
  f.number("mask_deg", c.mask_deg, {-10.0, 89.0}, "satellites below this elevation are not used");
  f.number("max_gdop", c.max_gdop, {1.0, 1e6}, "poorer geometry gives no fix");
  f.choice("frequencies", c.frequencies, ModelTable<Frequencies>(kFrequencies),
           "single = the first band alone; dual = ionosphere-free combination of two");
  f.choice("ephemeris", c.ephemeris, ModelTable<EphemerisChoice>(kEphemerides),
           "nearest_toe = the best orbit of the file; transmitted = what a receiver had at that time");
  f.choice("group_delay", c.group_delay, group_delay_models(),
           "broadcast = TGD, BGD, ISC for the band used; rtklib = the same, but GLONASS clocks read as those of an "
           "ionosphere-free combination");
  f.choice(
      "ionosphere", c.ionosphere, ionosphere_corrections(),
      "what is subtracted for the ionosphere: klobuchar = GPS's coefficients for all, klobuchar_own = each system's "
      "own where it sends some; with two frequencies it does not matter");
  f.choice("troposphere", c.troposphere, model_names(troposphere_corrections()),
           "what is subtracted for the troposphere");
  f.number("shared_ionosphere", c.shared_ionosphere, {0.0, 10.0},
           "1-sigma of the ionosphere model's scale, relative, solved as an unknown with that prior; 0 = trusted");
  f.number("smoothing_s", c.smoothing_s, {0.0, 86400.0},
           "time constant of the smoothing of code by carrier phase; 0 = off");
  f.choice("estimator", c.estimator, estimators(),
           "least_squares = each epoch by itself; kalman = position, velocity and time filtered");
  f.number("acceleration_m_s2", c.acceleration_m_s2, {1e-6, 1000.0},
           "kalman: white acceleration of the antenna per axis, m/s^2/sqrt(Hz)");
  visit_choice(f, "reported_covariance", c.reported_covariance, "the covariance that comes with a position");
  f.number("base_age_s", c.base_age_s, {0.0, 3600.0},
           "with a base: longest time from an epoch to the base's nearest, whose differences it is corrected by");
  f.choice("weighting", c.weighting, model_names(range_weightings()), "assumed 1-sigma of a corrected pseudorange");
  f.number("sigma_m", c.sigma_m, {1e-3, 1000.0}, "its size for a clear satellite at the zenith");
  f.number("doppler_sigma_m_s", c.doppler_sigma_m_s, {1e-4, 100.0},
           "assumed 1-sigma of a range rate from Doppler where that of the range is sigma_m");
  f.choice("fault_exclusion", c.fault_exclusion, model_names(fault_exclusions()), "test of the residuals");
  f.number("false_alarm", c.false_alarm, {1e-12, 0.5}, "probability that a good epoch fails that test");
  f.integer("max_exclusions", c.max_exclusions, {0, 100}, "satellites excluded at most");
}

Result<SinglePointConfig> read_single_point_config(const std::string& path) {
  CANYON_TRY(const ConfigNode node, ConfigNode::load(path));
  SinglePointConfig config;
  CANYON_TRY_STATUS(read_config(&node, "", config));
  return config;
}

}  // namespace canyon::gnss
