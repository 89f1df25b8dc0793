#include <algorithm>
#include <limits>

#include "canyon/core/check.h"
#include "canyon/gnss/satellites/navigation_data.h"

namespace canyon::gnss {
namespace {

/// The records of one kind, found by satellite and time. `Record` has sv, toe, healthy(), valid_at() and at().
template <class Record>
class RecordBook {
 public:
  RecordBook(std::vector<Record> records, EphemerisChoice choice) : records_(std::move(records)), choice_(choice) {
    for (const auto& r : records_) longest_s_ = std::max(longest_s_, reach_s(r));
    // Stable, so that of several records with the same toe the last one given stays last.
    std::stable_sort(records_.begin(), records_.end(),
                     [](const Record& a, const Record& b) { return a.sv != b.sv ? a.sv < b.sv : a.toe < b.toe; });
  }

  std::vector<SatelliteId> satellites() const {
    std::vector<SatelliteId> out;
    for (const auto& r : records_)
      if (out.empty() || out.back() != r.sv) out.push_back(r.sv);
    return out;
  }

  /// At t, by the record that is chosen at `received`.
  std::optional<SatelliteState> state(SatelliteId sv, GpsTime t, GpsTime received) const {
    const Record* record = choice_ == EphemerisChoice::kNearestToe ? nearest(sv, received) : transmitted(sv, received);
    if (record == nullptr || !record->healthy()) return std::nullopt;
    return record->at(t);
  }

 private:
  using Iterator = typename std::vector<Record>::const_iterator;

  /// First record of the satellite with toe >= t, or what comes after its records.
  Iterator not_before(SatelliteId sv, GpsTime t) const {
    return std::lower_bound(records_.begin(), records_.end(), std::pair(sv, t),
                            [](const Record& r, const std::pair<SatelliteId, GpsTime>& key) {
                              return r.sv != key.first ? r.sv < key.first : r.toe < key.second;
                            });
  }

  const Record* nearest(SatelliteId sv, GpsTime t) const {
    const Record* best = nullptr;
    std::int64_t best_ns = 0;
    for (auto it = not_before(sv, t - longest_s_); it != records_.end() && it->sv == sv; ++it) {
      const std::int64_t away_ns = std::abs(it->toe.ns - t.ns);
      if (it->toe > t && (away_ns > longest_s_ * 1e9 || (best != nullptr && away_ns > best_ns))) break;
      // Galileo's toe lies before the transmission (OS SIS ICD 5.1.2): one that is not past cannot have been received,
      // and is taken only for want of an earlier one.
      if (it->sv.system == GnssSystem::kGalileo && it->toe >= t && best != nullptr && best->toe < t) break;
      // At equal distance the later toe: it is the one on the air. GPS and QZSS send a set from two hours before its
      // toe until its toe (IS-GPS-200N 20.3.4.5), GLONASS one from 15 minutes before t_b to 15 after (ICD 4.4), and
      // BeiDou's sets begin with their toe. At equal toe the last given.
      if (!it->valid_at(t) || (best != nullptr && away_ns > best_ns)) continue;
      best = &*it;
      best_ns = away_ns;
    }
    return best;
  }

  /// Of the records transmitted by t the one of the latest toe; of those with the same toe the last given. A record
  /// that does not tell its time of transmission is taken to have been transmitted at its toe, GPS LNAV two hours
  /// before.
  const Record* transmitted(SatelliteId sv, GpsTime t) const {
    const Record* best = nullptr;
    for (auto it = not_before(sv, t - longest_s_); it != records_.end() && it->sv == sv; ++it) {
      if (it->toe > t + longest_s_) break;
      if (sent(*it) <= t && it->valid_at(t)) best = &*it;
    }
    return best;
  }

  static double reach_s(const KeplerEphemeris& r) { return std::max(r.valid_before_s, r.valid_after_s); }
  static double reach_s(const GlonassEphemeris&) { return GlonassEphemeris::kValidS; }
  static GpsTime sent(const KeplerEphemeris& r) {
    if (r.transmitted) return *r.transmitted;
    return r.message == NavigationMessage::kLnav ? r.toe - 7200.0 : r.toe;
  }
  static GpsTime sent(const GlonassEphemeris& r) { return r.toe - 900.0; }  // a frame is sent around its t_b

  std::vector<Record> records_;
  EphemerisChoice choice_;
  double longest_s_ = 0.0;  ///< no record is valid further from its toe than this
};

class Broadcast final : public Constellation {
 public:
  Broadcast(std::vector<KeplerEphemeris> kepler, std::vector<GlonassEphemeris> glonass, EphemerisChoice choice)
      : kepler_(std::move(kepler), choice), glonass_(std::move(glonass), choice) {
    satellites_ = kepler_.satellites();
    const auto more = glonass_.satellites();
    satellites_.insert(satellites_.end(), more.begin(), more.end());
    std::sort(satellites_.begin(), satellites_.end());
  }

  const std::vector<SatelliteId>& satellites() const override { return satellites_; }

  std::optional<SatelliteState> state(SatelliteId sv, GpsTime t) const override { return state_received(sv, t, t); }
  std::optional<SatelliteState> state_received(SatelliteId sv, GpsTime t, GpsTime received) const override {
    return sv.system == GnssSystem::kGlonass ? glonass_.state(sv, t, received) : kepler_.state(sv, t, received);
  }

 private:
  RecordBook<KeplerEphemeris> kepler_;
  RecordBook<GlonassEphemeris> glonass_;
  std::vector<SatelliteId> satellites_;
};

}  // namespace

NavigationData used_records(NavigationData data, const BroadcastOptions& options) {
  for (const char letter : options.systems)
    CANYON_CHECK(std::string_view("GRECJ").find(letter) != std::string_view::npos, "system ", letter);
  const auto wanted = [&](GnssSystem system) {
    return options.systems.find(system_letter(system)) != std::string::npos;
  };
  const auto rank = [&](NavigationMessage message) {
    const auto at = std::find(options.messages.begin(), options.messages.end(), message);
    return at - options.messages.begin();  // size = not wanted
  };
  const auto worst = static_cast<std::ptrdiff_t>(options.messages.size());

  // GEO satellites of BeiDou send D2, the others D1, so the two never compete for one satellite.
  std::map<SatelliteId, std::ptrdiff_t> best;
  for (const auto& r : data.kepler) {
    const auto known = best.emplace(r.sv, worst).first;
    known->second = std::min(known->second, rank(r.message));
  }
  std::erase_if(data.kepler, [&](const KeplerEphemeris& r) {
    return !wanted(r.sv.system) || rank(r.message) == worst || rank(r.message) != best.at(r.sv);
  });
  if (!wanted(GnssSystem::kGlonass) || rank(NavigationMessage::kFdma) == worst) data.glonass.clear();
  return data;
}

std::unique_ptr<Constellation> make_broadcast(const NavigationData& data, const BroadcastOptions& options) {
  NavigationData used = used_records(data, options);
  return std::make_unique<Broadcast>(std::move(used.kepler), std::move(used.glonass), options.choice);
}

}  // namespace canyon::gnss
