#include "canyon/core/tables/rtklib_header.h"

#include "canyon/core/files/line_reader.h"

namespace canyon {
namespace {

struct Name {
  std::string_view theirs;
  const char* ours;
};
constexpr Name kNames[] = {
    {"latitude(deg)", "lat_deg"},
    {"longitude(deg)", "lon_deg"},
    {"height(m)", "h_m"},
    {"x-ecef(m)", "x_m"},
    {"y-ecef(m)", "y_m"},
    {"z-ecef(m)", "z_m"},
    {"Q", "q"},
    {"sdn(m)", "sd_n_m"},
    {"sde(m)", "sd_e_m"},
    {"sdu(m)", "sd_u_m"},
    {"vn(m/s)", "vn_m_s"},
    {"ve(m/s)", "ve_m_s"},
    {"vu(m/s)", "vu_m_s"},
    {"sdvn", "sd_vn"},
    {"sdve", "sd_ve"},
    {"sdvu", "sd_vu"},
};

}  // namespace

bool is_rtklib_header(std::string_view line) {
  return line.find("latitude(deg)") != std::string_view::npos || line.find("x-ecef(m)") != std::string_view::npos;
}

RtklibHeader rtklib_header(std::string_view line, std::string_view row) {
  RtklibHeader out;
  const auto names = split(line, " \t", true);
  const bool dates = row.substr(0, row.find(' ')).find('/') != std::string_view::npos;
  out.columns = dates ? "date,clock" : "gps_week,sow";
  out.utc = !names.empty() && names.front() == "UTC";
  for (std::size_t i = 1; i < names.size(); ++i) {
    const char* ours = "-";
    for (const Name& name : kNames)
      if (names[i] == name.theirs) ours = name.ours;
    out.columns += std::string(",") + ours;
  }
  return out;
}

}  // namespace canyon
