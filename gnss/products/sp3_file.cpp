#include <algorithm>
#include <cmath>

#include "canyon/core/files/files.h"
#include "canyon/gnss/products/precise_orbits.h"
#include "canyon/gnss/rinex/calendar_fields.h"
#include "canyon/gnss/rinex/reader_warnings.h"
#include "canyon/gnss/rinex/satellite_name.h"
#include "canyon/gnss/rinex/text_lines.h"

namespace canyon::gnss {
namespace {

constexpr const char* kExpectedOrbit = "an SP3 file of version a, b, c or d";

/// How the file's time scale becomes GPS time.
enum class TimeScale { kGps, kBeidou, kUtc, kTai };

std::optional<TimeScale> time_scale(std::string_view name) {
  if (name == "GPS" || name == "GAL" || name == "QZS" || name == "ccc" || name.empty()) return TimeScale::kGps;
  if (name == "BDT" || name == "BDS") return TimeScale::kBeidou;
  if (name == "UTC" || name == "GLO") return TimeScale::kUtc;
  if (name == "TAI") return TimeScale::kTai;
  return std::nullopt;
}

GpsTime to_gps(GpsTime t, TimeScale scale) {
  switch (scale) {
    case TimeScale::kBeidou:
      return t + 14.0;
    case TimeScale::kUtc:
      return gps_time_of_utc(t);
    case TimeScale::kTai:
      return t - 19.0;
    case TimeScale::kGps:
      break;
  }
  return t;
}

class Sp3Reader {
 public:
  Sp3Reader(std::string_view text, const std::string& file)
      : lines_(text), file_(file), warnings_(file, "damaged lines") {}

  Result<PreciseOrbits> read() {
    CANYON_TRY_STATUS(header());
    bool ended = false;
    while (!ended && lines_.next()) {
      const std::string_view line = lines_.line();
      if (line.starts_with("*"))
        epoch(line);
      else if (line.starts_with("P"))
        position(line);
      else if (line.starts_with("V"))
        velocity(line);
      else if (line.starts_with("EOF"))
        ended = true;
      else if (!line.starts_with("E") && columns(line, 0, line.size()) != "")  // EP, EV: correlations
        header_line(line);
    }
    if (!ended) warnings_.note(std::max(lines_.number(), 1), "the file ends without \"EOF\": it may be truncated");
    if (out_.satellites.empty())
      return Error{file_, std::max(lines_.number(), 1), "", "no satellite position", kExpectedOrbit};
    for (auto& [sv, samples] : out_.satellites)
      std::stable_sort(samples.begin(), samples.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
    out_.files.push_back(file_);
    out_.warnings = warnings_.list();
    return out_;
  }

 private:
  Status header() {
    if (!lines_.next()) return Error{file_, 1, "", "the file is empty", kExpectedOrbit};
    const std::string_view first = lines_.line();
    if (first.size() < 3 || first[0] != '#' || std::string_view("abcd").find(first[1]) == std::string_view::npos ||
        std::string_view("PV").find(first[2]) == std::string_view::npos)
      return Error{file_, 1, "", "not an SP3 file: the first line does not start with \"#cP\" or its like",
                   kExpectedOrbit};
    if (!lines_.next() || !lines_.line().starts_with("##"))
      return Error{file_, 2, "", "the second line does not start with \"##\"", kExpectedOrbit};
    const auto interval = fortran_number(columns(lines_.line(), 24, 14));
    if (!interval || !(*interval > 0.0 && *interval < 1e5))
      return Error{file_, 2, "", "the epoch interval cannot be read", "seconds, in columns 25 to 38"};
    out_.interval_s = *interval;
    return Ok{};
  }

  /// Only the first %c line bears the time scale.
  void header_line(std::string_view line) {
    if (line.starts_with("%c") && !scale_known_) {
      scale_known_ = true;
      const auto scale = time_scale(columns(line, 9, 3));
      if (scale)
        scale_ = *scale;
      else
        warnings_.note(lines_.number(),
                       "time system \"" + printable(columns(line, 9, 3)) + "\" is not known, GPS assumed");
    } else if (!line.starts_with("%") && !line.starts_with("+") && !line.starts_with("/*")) {
      warnings_.note(lines_.number(), "a line of unknown kind \"" + printable(line.substr(0, 8)) + "\"; skipped");
    }
  }

  void epoch(std::string_view line) {
    const auto t = time_of_words(line.substr(1));
    t_ = t ? std::optional(to_gps(*t, scale_)) : std::nullopt;
    if (!t) warnings_.note(lines_.number(), "the epoch cannot be read; its satellites are skipped");
  }

  /// Satellite and four numbers; nullopt, with a warning, where they cannot be read.
  struct Row {
    std::optional<SatelliteId> sv;
    Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
    double fourth = 0.0;
    bool ok = false;
  };
  Row row(std::string_view line) {
    Row out;
    const std::string_view who = line.substr(1, 3);
    // A letter that is none of our systems is no mistake (NavIC, low satellites).
    out.sv = satellite_of_name(who);
    if (!out.sv && (who.empty() || who[0] < 'A' || who[0] > 'Z' || !whole_number(columns(who, 1, 2)))) {
      warnings_.note(lines_.number(), "satellite \"" + printable(who) + "\" cannot be read; skipped");
      return out;
    }
    const auto x = fortran_number(columns(line, 4, 14)), y = fortran_number(columns(line, 18, 14)),
               z = fortran_number(columns(line, 32, 14)), fourth = fortran_number(columns(line, 46, 14));
    const bool blank_clock = columns(line, 46, 14).empty();
    if (!x || !y || !z || (!fourth && !blank_clock)) {
      warnings_.note(lines_.number(), "the numbers of " + printable(who) + " cannot be read; skipped");
      return out;
    }
    out.xyz = {*x, *y, *z};
    out.fourth = fourth.value_or(999999.999999);
    out.ok = out.sv.has_value();
    return out;
  }

  void position(std::string_view line) {
    const Row r = row(line);
    last_ = nullptr;
    if (!t_ || !r.ok) return;
    if (r.xyz.isZero() || (r.xyz.cwiseAbs().array() > 999999.0).any()) return;  // not known
    const double radius_km = r.xyz.norm();
    if (!(radius_km > 6400.0 && radius_km < 1e5)) {
      warnings_.note(lines_.number(), r.sv->str() + " is " + join_values(std::round(radius_km)) +
                                          " km from the Earth's centre; skipped");
      return;
    }
    PreciseSample sample;
    sample.t = *t_;
    sample.p_E = 1e3 * r.xyz;
    if (std::abs(r.fourth) < 999999.0) sample.clock_s = 1e-6 * r.fourth;
    sample.clock_event = line.size() > 74 && line[74] == 'E';
    sample.manoeuvre = line.size() > 78 && line[78] == 'M';
    auto& samples = out_.satellites[*r.sv];
    if (!samples.empty() && samples.back().t == sample.t) {
      warnings_.note(lines_.number(), r.sv->str() + " stands twice in this epoch; the second is skipped");
      return;
    }
    samples.push_back(sample);
    last_ = &samples.back();
    last_sv_ = *r.sv;
  }

  void velocity(std::string_view line) {
    const Row r = row(line);
    if (!r.ok || last_ == nullptr || last_sv_ != *r.sv) return;
    if (!r.xyz.isZero() && (r.xyz.cwiseAbs().array() < 999999.0).all()) last_->v_E = 0.1 * r.xyz;  // dm/s
  }

  TextLines lines_;
  const std::string& file_;
  ReaderWarnings warnings_;
  PreciseOrbits out_;
  TimeScale scale_ = TimeScale::kGps;
  bool scale_known_ = false;
  std::optional<GpsTime> t_;
  PreciseSample* last_ = nullptr;  // that the next velocity belongs to
  SatelliteId last_sv_;
};

}  // namespace

std::string PreciseOrbits::names() const {
  std::string out;
  for (const auto& file : files) out += (out.empty() ? "" : ", ") + file;
  return out;
}

void PreciseOrbits::append(PreciseOrbits other) {
  files.insert(files.end(), other.files.begin(), other.files.end());
  warnings.insert(warnings.end(), other.warnings.begin(), other.warnings.end());
  interval_s = std::max(interval_s, other.interval_s);
  for (auto& [sv, more] : other.satellites) {
    auto& samples = satellites[sv];
    samples.insert(samples.end(), more.begin(), more.end());
    std::stable_sort(samples.begin(), samples.end(), [](const auto& a, const auto& b) {
      return a.t != b.t ? a.t < b.t : !std::isnan(a.clock_s) && std::isnan(b.clock_s);
    });
    samples.erase(std::unique(samples.begin(), samples.end(), [](const auto& a, const auto& b) { return a.t == b.t; }),
                  samples.end());
  }
}

Result<PreciseOrbits> parse_sp3_file(std::string_view text, const std::string& file_name) {
  return Sp3Reader(text, file_name).read();
}

Result<PreciseOrbits> read_sp3_file(const std::string& path) {
  CANYON_TRY(const std::string text, read_text_or_gzip_file(path));
  return parse_sp3_file(text, path);
}

Result<PreciseOrbits> read_sp3_files(const std::vector<std::string>& paths) {
  PreciseOrbits all;
  for (const auto& path : paths) {
    CANYON_TRY(PreciseOrbits one, read_sp3_file(path));
    all.append(std::move(one));
  }
  return all;
}

}  // namespace canyon::gnss
