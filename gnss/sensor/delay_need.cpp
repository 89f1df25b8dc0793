// What the receiver's mode lets through of the delays that do not depend on places.
#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"
#include "canyon/gnss/sensor/sensor_need.h"

namespace canyon::gnss {

namespace {

/// The largest that the chosen model of a table gives, if its row says so.
template <class Choice, class Rows, class... At>
std::optional<double> largest_m(const Choice& choice, const Rows& rows, const SkyView& lowest, const At&... at) {
  const auto& row = model_row(rows, choice.name);
  if (row.make.need == nullptr) return std::nullopt;
  const auto model = choice.make("", at...);
  if (!model) return std::nullopt;
  return row.make.need(**model, lowest);
}

bool switched_off(const GnssConfig& config, const std::string& effect) {
  return (effect == kIonosphere && config.ionosphere.name == "none") ||
         (effect == kTroposphere && config.troposphere.name == "none") ||
         (effect == kEphemeris && config.ephemeris_error.name == "none");
}

/// Whether a range's weight depends on what is subtracted for the ionosphere.
bool weighs_ionosphere(const GnssConfig& config) {
  const auto weighting = config.position.weighting.make("", RangeWeightingParameters{config.position.solver_sigma_m});
  if (!weighting) return true;
  const RangeQuality clear{.elevation_rad = 0.5, .cn0_dbhz = 45.0, .ionosphere_m = 0.0};
  RangeQuality delayed = clear;
  delayed.ionosphere_m = 10.0;
  return (*weighting)->sigma_m(clear) != (*weighting)->sigma_m(delayed);
}

/// Why leaving it out may change more than the range; empty: it does not.
std::string further_effect(const GnssConfig& config, const std::string& effect) {
  if (config.position.estimator == Estimator::kKalman)
    return "the receiver's own filter tests each range against what it expects";
  const bool ionosphere = effect == kIonosphere || effect == kIonosphereDifference;
  return ionosphere && weighs_ionosphere(config) ? "ranges are weighted by what is subtracted for it" : "";
}

}  // namespace

std::vector<Need> pseudorange_delay_needs(const GnssConfig& config, const GnssSurroundings& around) {
  const SkyView lowest{.t = around.start,
                       .receiver = geodetic_from_ecef(around.scene.frame().to_E({0.0, 0.0, around.low_m})),
                       .elevation_rad = config.mask_deg * kDegree,
                       .azimuth_rad = 0.0};
  DelayQuestion question{.ionosphere_m = largest_m(config.ionosphere, ionosphere_models(), lowest, IonosphereSetup{}),
                         .troposphere_m = largest_m(config.troposphere, troposphere_models(), lowest),
                         .ephemeris_m = std::nullopt,
                         .lowest_elevation_rad = lowest.elevation_rad,
                         .lat_rad = lowest.receiver.lat_rad};
  if (const auto& row = model_row(ephemeris_error_models(), config.ephemeris_error.name); row.make.need != nullptr)
    question.ephemeris_m = row.make.need(config.ephemeris_error.own);
  const auto& mode = model_row(receiver_modes(), config.mode.name);
  if (mode.make.need == nullptr) return {};
  std::vector<Need> needs;
  for (Need& need : mode.make.need(config.mode.own, question)) {
    if (switched_off(config, need.effect)) continue;
    if (const std::string why = further_effect(config, need.effect); need.bound > 0.0 && !why.empty()) {
      need.verdict = Verdict::kUndecidable;
      need.reason = why;
    }
    needs.push_back(std::move(need));
  }
  return needs;
}

DelayOmissions delays_of(const std::vector<Need>& needs) {
  const auto out = [&](const char* effect) {
    for (const Need& need : needs)
      if (need.effect == effect) return need.verdict == Verdict::kNotNeeded;
    return false;
  };
  return {.ionosphere = out(kIonosphere),
          .ionosphere_difference = out(kIonosphereDifference),
          .troposphere = out(kTroposphere),
          .troposphere_difference = out(kTroposphereDifference),
          .ephemeris = out(kEphemeris)};
}

}  // namespace canyon::gnss
