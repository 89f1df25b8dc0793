#include <sstream>

#include "canyon/core/check.h"
#include "canyon/gnss/rinex/navigation/navigation_file.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/tests/gnss/atmosphere/product_text.h"
#include "canyon/tests/gnss/rinex/hatanaka_compress.h"
#include "canyon/tests/gnss/rinex/nav_text.h"
#include "canyon/tests/mutation/deflated.h"
#include "canyon/tests/mutation/format.h"

namespace canyon::testing {
namespace {

using namespace canyon::gnss::testing;

/// What the IONEX twin of product_text.h covers.
const GpsTime kStart = GpsTime::from_calendar(2010, 12, 4, 0, 30, 0.0);
constexpr const char* kStartText = "2010-12-04T00:30:00";

/// Three epochs of four systems under open sky, and the satellites that were simulated.
const std::vector<Seed>& simulated() {
  static const std::vector<Seed> files = written_by_canyon(
      {"gnss",        "simulate", "--at",        "52.5,13.4,80", "--scene", "none",    "--systems",
       "GREC",        "--start",  kStartText,    "--duration",   "60",      "--rate",  "0.0333333333333333",
       "--rinex-obs", "obs.rnx",  "--rinex-nav", "nav.rnx",      "--nmea",  "log.nmea"},
      {"obs.rnx", "nav.rnx", "log.nmea"});
  return files;
}
const std::string& observations() {
  return simulated()[0].bytes;
}
const std::string& navigation() {
  return simulated()[1].bytes;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  CANYON_CHECK(at != std::string::npos, "from = ", from);
  return text.replace(at, from.size(), to);
}

/// GPS and GLONASS of the simulated epochs as RINEX 2.11.
std::string observations2() {
  std::string out = header_line("     2.11           OBSERVATION DATA    M (MIXED)", "RINEX VERSION / TYPE") +
                    header_line("  3783288.8231   901339.4151  5038190.1221", "APPROX POSITION XYZ") +
                    header_line("     4    C1    L1    D1    S1", "# / TYPES OF OBSERV") +
                    header_line("    30.000", "INTERVAL") +
                    header_line("  2010    12     4     0    30    0.0000000     GPS", "TIME OF FIRST OBS") +
                    header_line("", "END OF HEADER");
  std::istringstream in(observations());
  std::string line, heads, records;
  int satellites = 0;
  std::string epoch;
  const auto close = [&] {
    if (epoch.empty()) return;
    char count[8];
    std::snprintf(count, sizeof count, "%3d", satellites);
    std::string names = heads.substr(0, 36), rest = heads.size() > 36 ? heads.substr(36) : "";
    out += epoch + count + names + "\n";
    for (; !rest.empty(); rest = rest.size() > 36 ? rest.substr(36) : "")
      out += std::string(32, ' ') + rest.substr(0, 36) + "\n";
    out += records;
    heads.clear(), records.clear(), satellites = 0;
  };
  bool body = false;
  while (std::getline(in, line)) {
    if (line.find("END OF HEADER") != std::string::npos) {
      body = true;
    } else if (body && line[0] == '>') {
      close();
      epoch = " " + line.substr(4, 25) + "  0";  // "> 2010 12 04 00 30 00.0000000  0" without the century
    } else if (body && (line[0] == 'G' || line[0] == 'R')) {
      line.resize(67, ' ');
      heads += line.substr(0, 3);
      records += line.substr(3, 64) + "\n";
      ++satellites;
    }
  }
  close();
  return out;
}

std::string hatanaka(const std::string& rinex, bool modern) {
  const std::string two_lines =
      header_line(modern ? "3.0                 COMPACT RINEX FORMAT" : "1.0                 COMPACT RINEX FORMAT",
                  "CRINEX VERS   / TYPE") +
      header_line("a test", "CRINEX PROG / DATE");
  return gnss::HatanakaCompressor(modern).compress(rinex, two_lines);
}

std::string navigation2() {
  return navigation_text(kStart - 1800.0, 12, 2, false);
}

/// The GLONASS records of the simulated navigation file as RINEX 2.
std::string navigation2_glonass() {
  std::string out =
      header_line("     2.01           GLONASS NAV DATA", "RINEX VERSION / TYPE") + header_line("", "END OF HEADER");
  std::istringstream in(navigation());
  bool glonass = false;
  for (std::string line; std::getline(in, line);) {
    if (line[0] != ' ') glonass = line[0] == 'R';
    if (!glonass) continue;
    char head[32];
    if (line[0] == 'R') {
      std::snprintf(head, sizeof head, "%2d %.2s%3d%3d%3d%3d%5.1f", std::stoi(line.substr(1, 2)), line.c_str() + 6,
                    std::stoi(line.substr(9, 2)), std::stoi(line.substr(12, 2)), std::stoi(line.substr(15, 2)),
                    std::stoi(line.substr(18, 2)), std::stod(line.substr(21, 2)));
      out += head + line.substr(23) + "\n";
    } else {
      out += line.substr(1) + "\n";
    }
  }
  return out;
}

/// Each record of the simulated navigation file with its name before it, and one of each other kind of record.
std::string navigation4() {
  std::string out = header_line("     4.00           NAVIGATION DATA     M", "RINEX VERSION / TYPE") +
                    header_line("    15", "LEAP SECONDS") + header_line("", "END OF HEADER");
  std::istringstream in(navigation());
  bool body = false;
  for (std::string line; std::getline(in, line);) {
    if (line.find("END OF HEADER") != std::string::npos) {
      body = true;
      continue;
    }
    if (!body) continue;
    if (line[0] != ' ') {
      const char* message = line[0] == 'R' ? "FDMA" : line[0] == 'E' ? "INAV" : line[0] == 'C' ? "D1" : "LNAV";
      out += "> EPH " + line.substr(0, 3) + " " + message + "\n";
    }
    out += line + "\n";
  }
  const auto numbers = [](std::initializer_list<double> values) {
    std::string line = "    ";
    for (const double v : values) line += fortran(v);
    return line + "\n";
  };
  out += "> ION G12 LNAV\n    2010 12 04 00 08 54" + fortran(1e-8) + fortran(2e-8) + fortran(-3e-8) + "\n" +
         numbers({4e-8, 1e5, 2e5, -3e5}) + numbers({4e5});
  out += "> ION E02 IFNV\n    2010 12 04 00 11 25" + fortran(160.75) + fortran(0.371) + fortran(9.06e-3) + "\n" +
         numbers({0.0});
  out += "> STO E   IFNV\n    2010 12 04 00 20 00 GAGP\n" + numbers({1612.0, -2.5e-8, 2.6e-14, 0.0});
  out += "> EOP G27 CNVX\n    2010 12 04 00 51 12" + fortran(-0.04) + fortran(3.9e-5) + fortran(0.0) + "\n" +
         numbers({0.0, 0.35, 2.6e-3, 0.0}) + numbers({4392.0, -0.019, -1.4e-4, 0.0});
  return out;
}

std::unique_ptr<gnss::Constellation> broadcast() {
  const auto data = gnss::parse_navigation_file(navigation(), "nav.rnx");
  CANYON_CHECK(data.ok(), data.ok() ? "" : data.error().str());
  return gnss::make_broadcast(*data);
}

/// Three and a half hours around the epochs, of the satellites simulated; and a day's beginning with velocities.
std::vector<Seed> sp3_seeds() {
  std::vector<Seed> out{{"orbits.sp3", sp3_text(*broadcast(), kStart - 4500.0, 900.0, 12)},
                        {"orbits.sp3", sp3_text(*broadcast(), kStart - 4500.0, 900.0, 12, "UTC", true)}};
  for (Seed& seed : excerpt("gnss/orbit_2010_182/igs15904.sp3", "orbits.sp3", 60)) out.push_back(std::move(seed));
  return out;
}

std::vector<Companion> both() {
  return {{"obs.rnx", observations()}, {"nav.rnx", navigation()}};
}
std::vector<Companion> nav_beside() {
  return {{"nav.rnx", navigation()}};
}

const std::vector<std::string> kSolve{"gnss", "solve", "--obs", "@", "--nav", "nav.rnx", "--systems", "GREC"};

std::vector<Format> observation_formats() {
  return {{.name = "RinexObservation2",
           .command = kSolve,
           .read = {},
           .seeds =
               [] {
                 return with({{"obs.10o", observations2()}}, excerpt("gnss/arl_2015_200/arlm200a.15o", "arl.15o", 120));
               },
           .beside = nav_beside},
          {.name = "RinexObservation3",
           .command = kSolve,
           .read = {},
           .seeds =
               [] {
                 return with({{"obs.rnx", observations()}},
                             excerpt("gnss/urban_berlin/Berlin_Potsdamer_Platz.obs.gz", "berlin.obs", 90));
               },
           .beside = nav_beside},
          {.name = "RinexObservation4",
           .command = kSolve,
           .read = {},
           .seeds =
               [] {
                 return std::vector<Seed>{{"obs.rnx", replaced(observations(), "     3.04 ", "     4.00 ")}};
               },
           .beside = nav_beside},
          {.name = "Hatanaka1",
           .command = kSolve,
           .read = {},
           .seeds =
               [] {
                 return std::vector<Seed>{{"obs.10d", hatanaka(observations2(), false)}};
               },
           .beside = nav_beside},
          {.name = "Hatanaka3",
           .command = kSolve,
           .read = {},
           .seeds =
               [] {
                 return with(
                     {{"obs.crx", hatanaka(observations(), true)}},
                     with(excerpt("gnss/rinex4/KMS300DNK_R_20221591000_01H_30S_MO.crx", "kms.crx", 130),
                          excerpt("gnss/esbc_2020_177/ESBC00DNK_R_20201770000_01D_30S_MO.crx.gz", "esbc.crx", 150)));
               },
           .beside = nav_beside},
          {.name = "Gzip",
           .command = kSolve,
           .read = {},
           .seeds =
               [] {
                 return std::vector<Seed>{{"obs.rnx.gz", gzipped(observations())},
                                          {"obs.crx.gz", gzipped(hatanaka(observations(), true))}};
               },
           .beside = nav_beside}};
}

std::vector<Format> navigation_formats() {
  const std::vector<std::string> solve{"gnss", "solve", "--obs", "obs.rnx", "--nav", "@", "--systems", "GREC"};
  std::vector<std::string> without_ionosphere = solve;
  without_ionosphere.insert(without_ionosphere.end(), {"--config", "plain.toml"});
  const auto obs_beside = [] { return std::vector<Companion>{{"obs.rnx", observations()}}; };
  return {{.name = "RinexNavigation2",
           .command = without_ionosphere,
           .read = {},
           .seeds =
               [] {
                 return with({{"brdc.10n", navigation2()}, {"brdc.10g", navigation2_glonass()}},
                             with(excerpt("gnss/orbit_2010_182/brdc1820.10n", "real.10n", 60),
                                  excerpt("gnss/urban_berlin/brdc1580.16g", "real.16g", 40)));
               },
           .beside =
               [] {
                 return std::vector<Companion>{{"obs.rnx", observations()}, {"plain.toml", "ionosphere = \"none\"\n"}};
               }},
          {.name = "RinexNavigation3",
           .command = solve,
           .read = {},
           .seeds =
               [] {
                 return with({{"nav.rnx", navigation()}},
                             excerpt("gnss/urban_berlin/BRDC00WRD_U_20161580000_01D_MN.rnx", "real.rnx", 120));
               },
           .beside = obs_beside},
          {.name = "RinexNavigation4",
           .command = solve,
           .read = {},
           .seeds =
               [] {
                 return with({{"nav4.rnx", navigation4()}},
                             excerpt("gnss/rinex4/BRD400DLR_S_20230710000_01D_MN.rnx.gz", "real.rnx", 160));
               },
           .beside = obs_beside},
          // The same file as a constellation: fitted, sampled and written again.
          {.name = "RinexNavigationSimulated",
           .command = {"gnss", "simulate", "--nav", "@", "--at", "52.5,13.4,80", "--scene", "none", "--systems", "GREC",
                       "--start", kStartText},
           .read = {},
           .seeds = [] {
             return std::vector<Seed>{{"nav.rnx", navigation()}, {"nav4.rnx", navigation4()}};
           }}};
}

/// Two in each of six planes.
std::vector<AlmanacSatellite> almanac() {
  std::vector<AlmanacSatellite> out;
  for (int k = 0; k < 12; ++k) {
    AlmanacSatellite s = kAlmanac[0];
    s.prn = k + 1;
    s.node_rad = -3.1 + 1.05 * (k % 6);
    s.m_rad = -3.0 + 0.5 * k;
    out.push_back(s);
  }
  return out;
}

std::vector<Format> product_formats() {
  const auto nav2_beside = [] {
    return std::vector<Companion>{{"brdc.10n", navigation2()}, {"nav.rnx", navigation()}};
  };
  const auto sp3_beside = [] {
    return std::vector<Companion>{{"nav.rnx", navigation()},
                                  {"orbits.sp3", sp3_text(*broadcast(), kStart - 4500.0, 900.0, 12)}};
  };
  return {
      {.name = "Sp3",
       .command = {"gnss", "orbit-error", "--nav", "nav.rnx", "--sp3", "@"},
       .read = {},
       .seeds =
           [] {
             std::vector<Seed> seeds = sp3_seeds();
             seeds.resize(2);  // the real one is of another day
             return seeds;
           },
       .beside = nav2_beside},
      {.name = "Sp3Solved",
       .command = {"gnss", "solve", "--obs", "obs.rnx", "--nav", "nav.rnx", "--sp3", "@"},
       .read = {},
       .seeds = sp3_seeds,
       .beside = both},
      {.name = "RinexClock",
       .command = {"gnss", "orbit-error", "--nav", "nav.rnx", "--sp3", "orbits.sp3", "--clk", "@"},
       .read = {},
       .seeds =
           [] {
             return with({{"clocks.clk", clock_text(kStart - 4500.0, 35, 300.0)}},
                         excerpt("gnss/orbit_2010_182/igs15904.clk", "real.clk", 150));
           },
       .beside = sp3_beside},
      {.name = "Antex",
       .command = {"gnss", "orbit-error", "--nav", "nav.rnx", "--sp3", "orbits.sp3", "--antex", "@"},
       .read = {},
       .seeds =
           [] {
             return with({{"igs.atx", antex_text()}}, excerpt("gnss/antex/igs05.atx.gz", "real.atx", 200));
           },
       .beside = sp3_beside},
      {.name = "Ionex",
       .command = {"gnss", "solve", "--obs", "obs.rnx", "--nav", "nav.rnx", "--ionex", "@", "--config", "ionex.toml"},
       .read = {},
       .seeds =
           [] {
             return std::vector<Seed>{{"igs.10i", ionex_text()}};
           },
       .beside =
           [] {
             return with(both(), {{"ionex.toml", "ionosphere = \"ionex\"\n"}});
           }},
      {.name = "Almanac",
       .command = {"gnss", "sky", "--scene", "sky.toml", "--at", "32.35,-90.88,100", "--start", "2016-04-01T00:00:00"},
       .read = {},
       .seeds =
           [] {
             return std::vector<Seed>{{"current.alm", yuma_text(almanac())}, {"current.alm", sem_text(almanac())}};
           },
       .beside =
           [] {
             return std::vector<Companion>{
                 {"hut.obj", "v 0 0 0\nv 4 0 0\nv 4 3 3\no hut\nf 1 2 3\n"},
                 {"sky.toml", "[scene]\nfile = \"hut.obj\"\n[gnss]\nalmanac_file = \"current.alm\"\n"}};
           }}};
}

std::vector<Format> solution_formats() {
  const std::string geodetic =
      "gps_week,sow,lat_deg,lon_deg,h_m\n1612,520200,52.5,13.4,80\n1612,520230,52.5001,13.4001,80.5\n"
      "1612,520260,52.5002,13.4001,81\n";
  const std::string ecef =
      "# week sow x y z\n1612 520200.0 3783288.8231 901339.4151 5038190.1221\n"
      "1612 520230.0 3783289.8231 901340.4151 5038190.1221\n1612 520260.0 3783290.8231 901341.4151 5038190.1221\n";
  const auto places = [geodetic, ecef] { return std::vector<Seed>{{"places.csv", geodetic}, {"places.txt", ecef}}; };
  return {{.name = "PlacesTruth",
           .command = {"gnss", "solve", "--obs", "obs.rnx", "--nav", "nav.rnx", "--truth", "@"},
           .read = {},
           .seeds =
               [places] {
                 return with(places(), written_by_canyon({"gnss", "solve", "--obs", "obs.rnx", "--nav", "nav.rnx",
                                                          "--out", "solution.csv"},
                                                         {"solution.csv"}, both()));
               },
           .beside = both},
          {.name = "PlacesTrajectory",
           .command = {"gnss", "simulate", "--trajectory", "@", "--scene", "none", "--duration", "1"},
           .read = {},
           .seeds = places},
          {.name = "SolutionConfig",
           .command = {"gnss", "solve", "--obs", "obs.rnx", "--nav", "nav.rnx", "--config", "@"},
           .read = {},
           .seeds =
               [] {
                 return std::vector<Seed>{
                     {"solve.toml",
                      "systems = \"GRE\"\nmask_deg = 10.0\nmax_gdop = 30.0\nfrequencies = \"single\"\nestimator = "
                      "\"kalman\"\n"
                      "acceleration_m_s2 = 0.5\nionosphere = \"klobuchar_own\"\ntroposphere = \"saastamoinen_niell\"\n"
                      "shared_ionosphere = 0.5\nsmoothing_s = 100\nsigma_m = 0.3\nfalse_alarm = 1e-3\nmax_exclusions = "
                      "2\n"}};
               },
           .beside = both},
          {.name = "Nmea",
           .command = {"gnss", "solve", "--obs", "obs.rnx", "--nav", "nav.rnx", "--compare", "@"},
           .read = {},
           .seeds =
               [] {
                 auto recorded =
                     excerpt("gnss/google_mtv_2020/MTV.Local1.ublox-F9K.20200206-181434.nmea.gz", "real.nmea", 80);
                 for (Seed& seed : recorded) seed.fits = false;  // of another day
                 return with({simulated()[2]}, recorded);
               },
           .beside = both}};
}

}  // namespace

std::vector<Format> gnss_formats() {
  std::vector<Format> out;
  for (const auto& rows : {observation_formats(), navigation_formats(), product_formats(), solution_formats()})
    out.insert(out.end(), rows.begin(), rows.end());
  return out;
}

}  // namespace canyon::testing
