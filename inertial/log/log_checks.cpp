#include "canyon/inertial/log/log_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"

namespace canyon::inertial {
namespace {

double mean_of(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double v : x) sum += v;
  return sum / static_cast<double>(x.size());
}

std::string text(const char* format, auto... values) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

/// A sensor's noise never lets it stay at its largest value; a full scale does.
Status check_saturation(const ImuLog& log, int channel, const Places& places) {
  constexpr std::size_t kLongest = 5;          // samples in a row
  constexpr std::size_t kDistinctValues = 16;  // fewer: a sensor of coarse steps, which do stay
  const auto& x = log.channels[static_cast<std::size_t>(channel)];
  const auto [least, most] = std::minmax_element(x.begin(), x.end());
  for (const double extreme : {*most, *least}) {
    std::size_t run = 0, longest = 0, end = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      run = x[k] == extreme ? run + 1 : 0;
      if (run > longest) longest = run, end = k;
    }
    if (longest < kLongest) continue;
    std::vector<double> values = x;
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    if (values.size() < kDistinctValues) continue;
    return places.error(end + 1 - longest,
                        text("%s stays at its extreme value %.6g %s for %zu samples: saturated", kChannelNames[channel],
                             extreme, channel < 3 ? "rad/s" : "m/s^2", longest),
                        "a log within the sensor's range");
  }
  return Ok{};
}

/// So fast that the centripetal force on a unit may be any.
bool turns_fast(const ImuLog& log) {
  constexpr double kFast_rad_s = 5.0;
  if (log.channels[0].empty()) return false;
  double square = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    for (const double x : log.channels[c]) square += x * x / static_cast<double>(log.size());
  return square > kFast_rad_s * kFast_rad_s;
}

/// The magnitude of the specific force on average: a log that turns, as one of many positions does, has no mean
/// direction.
double mean_magnitude(const ImuLog& log, std::size_t first) {
  double sum = 0.0;
  for (std::size_t k = 0; k < log.size(); ++k)
    sum += std::hypot(log.channels[first][k], log.channels[first + 1][k], log.channels[first + 2][k]);
  return sum / static_cast<double>(log.size());
}
bool near(double value, double expected) {
  return std::abs(value / expected - 1.0) < 0.1;
}

/// Whether what is named rates reads 1 or 9.8 on average, in whichever unit it was written, and what is named forces is
/// nothing like that: gravity, in the other three columns.
bool exchanged(const ImuLog& log) {
  const auto& c = log.channels;
  if (c[0].empty() || std::hypot(mean_of(c[3]), mean_of(c[4]), mean_of(c[5])) > 0.5 * kStandardGravity) return false;
  const double rate = mean_magnitude(log, 0);
  for (const double unit : {1.0, kDegree})
    for (const double gravity : {1.0, kStandardGravity})
      if (near(rate, gravity * unit)) return true;
  return false;
}

/// What no unit can show on average. `as_increments`: the file is said to hold increments.
Status check_force(ImuLog& log, const Judge& judge, bool as_increments) {
  const double force = mean_magnitude(log, 3), interval_s = judge.interval_s;
  if (near(force, kStandardGravity)) return Ok{};
  const std::string figure = text("mean specific force %.4g m/s^2: ", force);
  if (as_increments) {
    if (near(force, kStandardGravity / interval_s))
      return judge.places.error(0, figure + "these are rates, where increments are said", "names in _m_s2");
    return Ok{};
  }
  struct Mistake {
    double force;
    const char* what;
    const char* expected;
  };
  const Mistake mistakes[] = {
      {kStandardGravity * interval_s, "these are velocity increments, not rates", "names in _m_s"},
      {1.0, "these are g", "names in _g"},
      {1000.0, "these are mg", "names in _mg"},
      {100.0 * kStandardGravity, "these are cm/s^2", "_m_s2*0.01"},
      {kStandardGravity * kStandardGravity, "these are m/s^2", "names in _m_s2"},
  };
  const auto off = [&](const Mistake& m) { return std::abs(force / m.force - 1.0); };
  const Mistake& nearest = *std::min_element(std::begin(mistakes), std::end(mistakes),
                                             [&](const Mistake& a, const Mistake& b) { return off(a) < off(b); });
  if (!near(force, nearest.force)) {
    if (!exchanged(log)) return Ok{};
    return judge.places.error(0, figure + "gravity is in the columns that are named rates",
                              "rates and forces in the columns that name them");
  }
  const Error error = judge.places.error(0, figure + nearest.what, nearest.expected);
  if (!judge.named_units || !turns_fast(log)) return error;
  log.doubts.push_back(error.str() + "; taken as named, for the unit turns fast");
  return Ok{};
}

Status check_rates(ImuLog& log, const Judge& judge, bool as_increments) {
  constexpr double kLargest = 100.0;  // rad/s; the fastest gyroscopes on the market end at 70 (4000 deg/s)
  const Places& places = judge.places;
  // Where the accelerometer is of the same kind, gravity has spoken for both.
  const bool same_kind = !log.channels[3].empty() && log.increments[1] == as_increments;
  for (std::size_t c = 0; c < 3 && !(as_increments && same_kind); ++c)
    for (std::size_t k = 0; k < log.channels[c].size(); ++k) {
      if (!(std::abs(log.channels[c][k]) > kLargest)) continue;
      const Error error =
          places.error(k,
                       text("%s = %.4g rad/s: no gyroscope goes so far; these are %s", kChannelNames[c],
                            log.channels[c][k], as_increments ? "rates, where increments are said" : "deg/s"),
                       as_increments ? "names in _rad_s" : "names in _deg_s");
      if (!judge.named_units) return error;
      log.doubts.push_back(text("%s:%d: %s = %.4g rad/s, taken as named: no gyroscope on the market goes so far",
                                places.path.c_str(), places.lines[k], kChannelNames[c], log.channels[c][k]));
      return Ok{};
    }
  // Only the Earth's rate itself tells rates from increments: a MEMS bias may have any size, but hardly just that.
  if (same_kind || log.channels[0].empty()) return Ok{};
  const double rate = std::hypot(mean_of(log.channels[0]), mean_of(log.channels[1]), mean_of(log.channels[2]));
  const double interval_s = judge.interval_s;
  const double mistaken = as_increments ? Wgs84::rate_rad_s / interval_s : Wgs84::rate_rad_s * interval_s;
  if (std::abs(rate / mistaken - 1.0) >= 0.1) return Ok{};
  return places.error(0,
                      as_increments
                          ? text("mean rate %.4g rad/s is the Earth's by the interval: these are rates, where "
                                 "increments are said",
                                 rate)
                          : text("mean rate %.4g rad/s is the Earth's times the interval: these are angle increments, "
                                 "not rates",
                                 rate),
                      as_increments ? "names in _rad_s" : "names in _rad");
}

}  // namespace

Status check_live(const ImuLog& log, const Places& places) {
  for (int c = 0; c < 6; ++c) {
    const auto& x = log.channels[static_cast<std::size_t>(c)];
    if (x.size() <= 10) continue;
    if (std::all_of(x.begin(), x.end(), [&](double v) { return v == x.front(); }))
      return places.error(0, std::string(kChannelNames[c]) + " never changes", "a channel that is alive");
    CANYON_TRY_STATUS(check_saturation(log, c, places));
  }
  return Ok{};
}

Status check_magnitudes(ImuLog& log, const Judge& judge) {
  if (!log.channels[3].empty()) CANYON_TRY_STATUS(check_force(log, judge, log.increments[1]));
  return check_rates(log, judge, log.increments[0]);
}

Status check_range(const ImuLog& log, const Places& places) {
  constexpr double kLargest = 1e12;  // rad/s, m/s^2
  for (std::size_t c = 0; c < 6; ++c)
    for (std::size_t k = 0; k < log.channels[c].size(); ++k)
      if (!(std::abs(log.channels[c][k]) <= kLargest))
        return places.error(
            k, text("%s = %.4g %s is out of range", kChannelNames[c], log.channels[c][k], c < 3 ? "rad/s" : "m/s^2"),
            "a rate or force below 1e12");
  return Ok{};
}

Status check_times(const ImuLog& log, double interval_s, const Places& places) {
  constexpr double kLatest_s = 9.2e9, kShortest_s = 1e-9;
  for (const std::size_t k : {std::size_t{0}, log.size() - 1})
    if (std::abs(log.t_s[k]) > kLatest_s)
      return places.error(k, text("time %.6g s", log.t_s[k]), "seconds from -9.2e9 to 9.2e9");
  if (interval_s >= kShortest_s) return Ok{};
  return places.error(0, text("samples %.3g s apart", interval_s), "a nanosecond or more; is the time's unit right?");
}

}  // namespace canyon::inertial
