#pragma once

#include <array>
#include <map>
#include <optional>

#include "canyon/core/model_table.h"
#include "canyon/gnss/satellites/navigation_data.h"

namespace canyon::gnss {

enum class GroupDelayModel { kNone, kBroadcast, kRtklib };
/// What a user of one band, or of the ionosphere-free combination of two, subtracts from the satellite clock.
ModelTable<GroupDelayModel> group_delay_models();

/// Group delays after one of these models.
///
///   none       nothing
///   broadcast  TGD, BGD and ISC of the record in use
///   rtklib     as RTKLIB 2.4.3 does, to compare with it: the values of the satellite's first record in the order of
///              transmission, also where that is a Galileo F/NAV record, which has no BGD(E1, E5b) and so counts as 0;
///              and GLONASS clocks are read as those of an ionosphere-free combination, while its ICD refers them to G1
class GroupDelays {
 public:
  GroupDelays(GroupDelayModel model, const NavigationData& navigation);

  /// s. `second_band`: of the combination with `band`.
  double delay_s(const SatelliteState& state, SatelliteId sv, int band, std::optional<int> second_band) const;
  /// 1-sigma of delay_s(), m: 0 where the message tells it, else how far a lent one (SatelliteState) is off.
  double sigma_m(const SatelliteState& state, SatelliteId sv, int band, std::optional<int> second_band) const;

 private:
  std::array<double, 10> by_band_s(const SatelliteState& state, SatelliteId sv) const;

  GroupDelayModel model_;
  std::map<SatelliteId, std::array<double, 10>> rtklib_s_;
};

}  // namespace canyon::gnss
