#pragma once

#include <map>

namespace canyon::gnss {

/// Frequency number by slot, 1 to 24: the public plan in force since 2010 (gnss/tables/glonass_channels.csv).
std::map<int, int> glonass_channel_plan();

}  // namespace canyon::gnss
