#pragma once

#include "canyon/gnss/rinex/record_fields.h"
#include "canyon/gnss/satellites/navigation_data.h"

namespace canyon::gnss {

/// RINEX 4's record ION of LNAV (GPS, QZSS), CNVX (GPS, QZSS) and D1D2; `record` starts with the line that bears the
/// epoch.
Result<BroadcastKlobuchar> parse_klobuchar_record(const RecordLines& record, SatelliteId sv);

}  // namespace canyon::gnss
