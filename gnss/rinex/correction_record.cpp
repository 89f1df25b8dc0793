#include "gnss/rinex/correction_record.h"

#include "gnss/rinex/text_lines.h"
#include "gnss/satellites/system_constants.h"

namespace canyon::gnss {
namespace {

std::optional<Error> wrong_length(const RecordLines& record, SatelliteId sv, std::size_t lines) {
  if (record.lines.size() == lines) return std::nullopt;
  return Error{record.file, record.first_line, "",
               sv.str() + ": the record has " + std::to_string(record.lines.size()) + " lines", std::to_string(lines)};
}

}  // namespace

Result<BroadcastKlobuchar> parse_klobuchar_record(const RecordLines& record, SatelliteId sv) {
  if (auto error = wrong_length(record, sv, 3)) return *std::move(error);
  RecordFields f(record, sv.str());
  BroadcastKlobuchar out;
  out.system = sv.system;
  out.t = f.epoch() + constants_of(sv.system).ahead_s;
  auto& a = out.coefficients.alpha;
  auto& b = out.coefficients.beta;
  for (std::size_t i = 0; i < 3; ++i) a[i] = f.clock(i, "alpha");
  a[3] = f.orbit(1, 0, "alpha 3");
  for (std::size_t i = 0; i < 3; ++i) b[i] = f.orbit(1, i + 1, "beta");
  b[3] = f.orbit(2, 0, "beta 3");
  if (!f.ok()) return f.error();
  return out;
}

Result<BroadcastNequick> parse_nequick_record(const RecordLines& record, SatelliteId sv) {
  if (auto error = wrong_length(record, sv, 2)) return *std::move(error);
  RecordFields f(record, sv.str());
  const BroadcastNequick out{f.epoch(), f.clock(0, "a0"), f.clock(1, "a1"), f.clock(2, "a2")};
  if (!f.ok()) return f.error();
  return out;
}

Result<TimeSystemCorrection> parse_time_offset_record(const RecordLines& record, SatelliteId sv) {
  if (auto error = wrong_length(record, sv, 2)) return *std::move(error);
  RecordFields f(record, sv.str());
  TimeSystemCorrection out;
  out.t_reference = f.epoch() + constants_of(sv.system).ahead_s;
  out.code = columns(record.lines.front(), 24, 18);
  out.a0_s = f.orbit(1, 1, "a0");
  out.a1 = f.orbit(1, 2, "a1", false);
  out.a2_per_s = f.orbit(1, 3, "a2", false);
  f.require(out.code.size() == 4, 0, "time offset \"" + printable(out.code) + "\"", "a code of four letters");
  if (!f.ok()) return f.error();
  return out;
}

}  // namespace canyon::gnss
