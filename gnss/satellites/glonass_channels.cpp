#include "canyon/gnss/satellites/glonass_channels.h"

#include "canyon/gnss/satellites/csv_table.h"

namespace canyon::gnss {

std::map<int, int> glonass_channel_plan() {
  std::map<int, int> channels;
  for (const auto& row : table_rows("gnss/tables/glonass_channels.csv"))
    channels[static_cast<int>(table_number(row[0]))] = static_cast<int>(table_number(row[1]));
  return channels;
}

}  // namespace canyon::gnss
