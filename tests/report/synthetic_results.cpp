#include "canyon/tests/report/synthetic_results.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "canyon/core/check.h"
#include "canyon/study/results/figures.h"
#include "canyon/tests/report/synthetic_city.h"
#include "canyon/tests/report/synthetic_run.h"

namespace canyon::testing {

void store(const std::string& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  CANYON_CHECK(out.good(), "file = ", file);
}

std::string load(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  CANYON_CHECK(in.good(), "file = ", file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

nlohmann::ordered_json load_json(const std::string& file) {
  return nlohmann::ordered_json::parse(load(file));
}

void write_synthetic_results(const std::string& directory, const SyntheticOptions& options) {
  using nlohmann::ordered_json;
  const SyntheticCity city(2012);
  std::filesystem::create_directories(directory + "/epochs");
  if (options.clouds) std::filesystem::create_directories(directory + "/clouds");

  struct Wanted {
    const char *fidelity, *gnss, *imu;
  };
  std::vector<Wanted> wanted{{"low", "low", "low"}, {"high", "high", "high"}};
  if (options.paper) wanted.push_back({"paper", "paper", "paper"});
  if (options.mixed)
    wanted.insert(wanted.end(), {{"high_gnss_low_imu", "high", "low"}, {"low_gnss_high_imu", "low", "high"}});

  ordered_json summary{{"schema", 1}, {"mission", city.mission_json()}};
  summary["scene"] = {{"name", "city"},
                      {"buildings", city.houses.size()},
                      {"triangles", 523412},
                      {"extent_m", {1000.0, 1000.0, 115.0}},
                      {"origin", {{"lat_deg", 32.35}, {"lon_deg", -90.88}, {"h_m", 60.0}}}};
  summary["figures"] = study::figure_descriptions();
  summary["runs"] = ordered_json::array();
  for (const Wanted& w : wanted) {
    const SyntheticRun run(city, options, w.fidelity, w.gnss, w.imu);
    summary["runs"].push_back(run.summary());
    const std::string stem = directory + "/epochs/" + w.fidelity;
    store(stem + "_nav.csv", run.nav_csv());
    store(stem + "_gnss.csv", run.gnss_csv());
    if (run.has_satellites()) store(stem + "_satellites.csv", run.satellites_csv());
    store(stem + "_keyframes.csv", run.keyframes_csv());
    if (options.clouds) {
      store(directory + "/clouds/" + w.fidelity + "_prior.pcd", run.cloud_pcd(false));
      store(directory + "/clouds/" + w.fidelity + "_registered.pcd", run.cloud_pcd(true));
    }
  }
  summary["two_by_two"] = nullptr;
  if (options.mixed) {
    const auto figure = [&](const char* key) {
      const auto of = [&](std::size_t i) { return summary["runs"][i][key]; };
      const std::size_t mixed = options.paper ? 3 : 2;
      return ordered_json::array(
          {ordered_json::array({of(0), of(mixed + 1)}), ordered_json::array({of(mixed), of(1)})});
    };
    summary["two_by_two"] = {{"gnss", ordered_json::array({"low", "high"})},
                             {"imu", ordered_json::array({"low", "high"})},
                             {"outcome", figure("outcome")},
                             {"position_error_rms_m", figure("position_error_rms_m")},
                             {"registration_error_rms_m", figure("registration_error_rms_m")},
                             {"map_error_prior_rms_m", figure("map_error_prior_rms_m")}};
  }
  summary["hash"] = "9f2c4b1f3cbb2a86b9e6b0c7f3b7ad6e61a1f0e2d3c4b5a69788796a5b4c3d2e";
  summary["timing"] = {{"wall_s", 84.2}, {"cpu_s", 151.0}, {"peak_memory_mb", 1240.0}, {"threads", 2}};
  store(directory + "/summary.json", summary.dump(1));
  store(directory + "/scene.json", city.scene_json().dump(1));
  store(directory + "/manifest.json",
        ordered_json{{"version", "0.1.0"}, {"seed", 42}, {"instruction_set", "avx2"}, {"scene_hash", "51ac70de"}}.dump(
            1));
}

}  // namespace canyon::testing
