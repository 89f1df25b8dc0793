#include "canyon/gnss/single_point/group_delay.h"

#include <cmath>
#include <utility>

#include "canyon/core/units.h"
#include "canyon/gnss/products/clock_datum.h"

namespace canyon::gnss {
namespace {

constexpr double kLentDelayS = 3.3e-9;  // KeplerEphemeris::group_delay_s()
constexpr double kGlonassGamma = (1602.0 / 1246.0) * (1602.0 / 1246.0);

std::array<double, 10> rtklib_bands_s(const KeplerEphemeris& r) {
  auto out = r.group_delay_s();
  if (r.sv.system == GnssSystem::kGalileo) out[1] = r.tgd2_s;  // BGD(E1, E5b), whatever the message
  return out;
}

}  // namespace

ModelTable<GroupDelayModel> group_delay_models() {
  static constexpr ModelRow<GroupDelayModel> kRows[] = {
      {"none", GroupDelayModel::kNone, "nothing"},
      {"broadcast", GroupDelayModel::kBroadcast, "TGD, BGD and ISC of the record in use"},
      {"rtklib", GroupDelayModel::kRtklib, "as RTKLIB 2.4.3 does"},
  };
  return kRows;
}

GroupDelays::GroupDelays(GroupDelayModel model, const NavigationData& navigation) : model_(model) {
  if (model_ != GroupDelayModel::kRtklib) return;
  std::map<SatelliteId, const KeplerEphemeris*> first;
  const auto order = [](const KeplerEphemeris& r) { return std::pair(r.transmitted.value_or(r.toe), r.toe); };
  for (const auto& r : navigation.kepler) {
    const auto [known, added] = first.emplace(r.sv, &r);
    if (!added && order(r) < order(*known->second)) known->second = &r;
  }
  for (const auto& [sv, r] : first) rtklib_s_[sv] = rtklib_bands_s(*r);
}

std::array<double, 10> GroupDelays::by_band_s(const SatelliteState& state, SatelliteId sv) const {
  if (model_ == GroupDelayModel::kNone) return {};
  auto out = state.group_delay_s;
  if (model_ != GroupDelayModel::kRtklib) return out;
  if (const auto known = rtklib_s_.find(sv); known != rtklib_s_.end()) out = known->second;
  if (sv.system == GnssSystem::kGlonass) {
    // delta tau = G2 - G1; with the combination's clock, G1 is early by delta tau / (gamma - 1).
    out[1] = -out[2] / (kGlonassGamma - 1.0);
    out[2] = kGlonassGamma * out[1];
  }
  return out;
}

double GroupDelays::delay_s(const SatelliteState& state, SatelliteId sv, int band,
                            std::optional<int> second_band) const {
  const auto delay_s = by_band_s(state, sv);
  const double first_s = delay_s.at(static_cast<std::size_t>(band));
  if (!second_band) return first_s;
  const CombinationWeights w = ionosphere_free(sv.system, {band, *second_band});
  return w.first * first_s + w.second * delay_s.at(static_cast<std::size_t>(*second_band));
}

double GroupDelays::sigma_m(const SatelliteState& state, SatelliteId sv, int band,
                            std::optional<int> second_band) const {
  if (model_ == GroupDelayModel::kNone) return 0.0;
  const auto of_band = [&](int b) {
    return (state.borrowed_delay_bands >> b & 1u) != 0 ? kSpeedOfLight * kLentDelayS : 0.0;
  };
  if (!second_band) return of_band(band);
  const CombinationWeights w = ionosphere_free(sv.system, {band, *second_band});
  return std::hypot(w.first * of_band(band), w.second * of_band(*second_band));
}

}  // namespace canyon::gnss
