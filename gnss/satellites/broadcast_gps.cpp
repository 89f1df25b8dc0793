#include <algorithm>

#include "core/check.h"
#include "gnss/satellites/lnav_ephemeris.h"

namespace canyon::gnss {
namespace {

class BroadcastGps final : public Constellation {
 public:
  explicit BroadcastGps(std::vector<LnavEphemeris> records) : records_(std::move(records)) {
    // Stable, so that of several records with the same toe the last one given stays last.
    std::stable_sort(records_.begin(), records_.end(), [](const LnavEphemeris& a, const LnavEphemeris& b) {
      return a.sv != b.sv ? a.sv < b.sv : a.toe < b.toe;
    });
    for (const auto& r : records_)
      if (satellites_.empty() || satellites_.back() != r.sv) satellites_.push_back(r.sv);
  }

  const std::vector<SatelliteId>& satellites() const override { return satellites_; }

  std::optional<SatelliteState> state(SatelliteId sv, GpsTime t) const override {
    const LnavEphemeris* record = nearest(sv, t);
    if (record == nullptr || !record->healthy() || !record->valid_at(t)) return std::nullopt;
    return record->at(t);
  }

 private:
  const LnavEphemeris* nearest(SatelliteId sv, GpsTime t) const {
    // First record of this satellite with toe > t; the nearest is it or the one before.
    const auto after = std::upper_bound(records_.begin(), records_.end(), std::pair(sv, t),
                                        [](const std::pair<SatelliteId, GpsTime>& key, const LnavEphemeris& r) {
                                          return key.first != r.sv ? key.first < r.sv : key.second < r.toe;
                                        });
    const bool has_after = after != records_.end() && after->sv == sv;
    const bool has_before = after != records_.begin() && std::prev(after)->sv == sv;
    if (!has_after && !has_before) return nullptr;
    if (has_before && (!has_after || t - std::prev(after)->toe <= after->toe - t)) return &*std::prev(after);
    auto last_same_toe = after;
    while (std::next(last_same_toe) != records_.end() && std::next(last_same_toe)->sv == sv &&
           std::next(last_same_toe)->toe == after->toe)
      ++last_same_toe;
    return &*last_same_toe;
  }

  std::vector<LnavEphemeris> records_;
  std::vector<SatelliteId> satellites_;
};

}  // namespace

std::unique_ptr<Constellation> make_broadcast_gps(std::vector<LnavEphemeris> records) {
  return std::make_unique<BroadcastGps>(std::move(records));
}

}  // namespace canyon::gnss
