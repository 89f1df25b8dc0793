#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/satellites/csv_table.h"
#include "canyon/gnss/signal.h"

namespace canyon::gnss {
namespace {

constexpr const char* kTable = "gnss/tables/gps_sps_24slot.csv";
// SPS Performance Standard 2001, table 3-1 and table A-2-1 (node rate).
constexpr double kRadiusM = 26559.7e3;
constexpr double kInclinationRad = 55.0 * kDegree;
constexpr double kNodeRateRadS = -4.4874e-7 * kDegree;
constexpr double kGreenwichAngleRad = 279.060 * kDegree;

struct Slot {
  double node_rad;          // right ascension of the ascending node at the epoch
  double argument_lat_rad;  // at the epoch
};

std::vector<Slot> read_slots() {
  std::vector<Slot> slots;
  for (const auto& row : table_rows(kTable))
    slots.push_back({table_number(row[1]) * kDegree, table_number(row[2]) * kDegree});
  CANYON_CHECK(slots.size() == 24, kTable, " has ", slots.size(), " slots");
  return slots;
}

class NominalGps final : public Constellation {
 public:
  NominalGps() : slots_(read_slots()), epoch_(GpsTime::from_calendar(1993, 7, 1, 0, 0, 9.0)) {  // GPS - UTC = 9 s then
    for (std::size_t i = 0; i < slots_.size(); ++i)
      satellites_.push_back({GnssSystem::kGps, static_cast<std::uint8_t>(i + 1)});
  }

  const std::vector<SatelliteId>& satellites() const override { return satellites_; }

  std::optional<SatelliteState> state(SatelliteId sv, GpsTime t) const override {
    if (sv.system != GnssSystem::kGps || sv.prn < 1 || sv.prn > slots_.size()) return std::nullopt;
    const Slot& slot = slots_[sv.prn - 1];
    const double node_dot = kNodeRateRadS - kGpsEarthRate;  // of the node in the rotating frame
    const double u_dot = -2.0 * node_dot;  // two revolutions per turn under the node: repeating ground track
    const double node = slot.node_rad - kGreenwichAngleRad + turned(node_dot, t);
    const double u = slot.argument_lat_rad + turned(u_dot, t);
    const double sin_u = std::sin(u), cos_u = std::cos(u), sin_n = std::sin(node), cos_n = std::cos(node);
    const double sin_i = std::sin(kInclinationRad), cos_i = std::cos(kInclinationRad);
    SatelliteState s;
    s.p_E = kRadiusM * Eigen::Vector3d(cos_u * cos_n - sin_u * cos_i * sin_n, cos_u * sin_n + sin_u * cos_i * cos_n,
                                       sin_u * sin_i);
    const Eigen::Vector3d along(-sin_u * cos_n - cos_u * cos_i * sin_n, -sin_u * sin_n + cos_u * cos_i * cos_n,
                                cos_u * sin_i);
    s.v_E = kRadiusM * u_dot * along + node_dot * Eigen::Vector3d(-s.p_E.y(), s.p_E.x(), 0.0);
    return s;
  }

 private:
  /// Angle turned at a constant rate since the epoch, modulo 2 pi. Whole days are reduced on their own: decades from
  /// the epoch a plain product would be off by 0.4 mm, and not smooth.
  double turned(double rate_rad_s, GpsTime t) const {
    constexpr std::int64_t kDayNs = 86400 * kNsPerSecond;
    const std::int64_t since_ns = t.ns - epoch_.ns;
    const std::int64_t days = since_ns / kDayNs;
    const double rest_s = 1e-9 * static_cast<double>(since_ns % kDayNs);
    const double per_day = std::remainder(rate_rad_s * 86400.0, 2.0 * kPi);
    return std::remainder(static_cast<double>(days) * per_day, 2.0 * kPi) + rate_rad_s * rest_s;
  }

  std::vector<Slot> slots_;
  GpsTime epoch_;
  std::vector<SatelliteId> satellites_;
};

}  // namespace

std::unique_ptr<Constellation> make_nominal_gps() {
  return std::make_unique<NominalGps>();
}

}  // namespace canyon::gnss
