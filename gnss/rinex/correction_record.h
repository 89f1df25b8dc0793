#pragma once

#include <optional>
#include <string_view>

#include "gnss/rinex/record_fields.h"
#include "gnss/satellites/navigation_data.h"

namespace canyon::gnss {

/// RINEX 4's records beside the ephemerides; `record` starts with the line that bears the epoch.

/// ION of LNAV (GPS, QZSS), CNVX (GPS, QZSS) and D1D2: Klobuchar.
Result<BroadcastKlobuchar> parse_klobuchar_record(const RecordLines& record, SatelliteId sv);
/// ION of Galileo, IFNV.
Result<BroadcastNequick> parse_nequick_record(const RecordLines& record, SatelliteId sv);
/// STO: offset of two time systems.
Result<TimeSystemCorrection> parse_time_offset_record(const RecordLines& record, SatelliteId sv);

}  // namespace canyon::gnss
