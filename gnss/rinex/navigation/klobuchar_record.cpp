#include "canyon/gnss/rinex/navigation/klobuchar_record.h"

#include "canyon/gnss/satellites/system_constants.h"

namespace canyon::gnss {

Result<BroadcastKlobuchar> parse_klobuchar_record(const RecordLines& record, SatelliteId sv) {
  if (record.lines.size() != 3)
    return Error{record.file, record.first_line, "",
                 sv.str() + ": the record has " + std::to_string(record.lines.size()) + " lines", "3"};
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
  f.require(is_sane(out.coefficients), 0, "Klobuchar coefficients that no message can hold",
            "alpha up to 1e-4, beta up to 1e8");
  if (!f.ok()) return f.error();
  return out;
}

}  // namespace canyon::gnss
