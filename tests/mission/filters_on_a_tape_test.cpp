// The two filters on one true motion of the built-in route, with sideslip and a unit askew: what the README and
// docs/fusion.md say of them over twenty seeds, on three that no figure there is made of.
#include <algorithm>
#include <cmath>
#include <string>

#include "canyon/core/files/files.h"
#include "canyon/mission/route_tape.h"
#include "canyon/tests/mission/short_mission.h"

namespace canyon::mission::testing {
namespace {

constexpr const char* kRoute = R"(
base = "vicksburg"
[registration]
method = "none"
[vehicle]
sideslip_deg_per_m_s2 = 0.6
[imu]
mounting_error_deg = 0.5
)";

MissionConfig route_config(const std::string& fidelity, int seed) {
  auto file = MissionFile::parse(kRoute, "route.toml");
  EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.error().str());
  auto config = file->resolve(fidelity);
  EXPECT_TRUE(config.ok()) << (config.ok() ? "" : config.error().str());
  config->run.seed = seed;
  return *config;
}

struct Errors {
  double rms_m = 0.0, horizontal_m = 0.0, largest_m = 0.0;
};

Errors errors_of(const std::string& fidelity, int seed, const Tape& tape) {
  Omissions unread;
  unread.registration = unread.maps = unread.keyframes = unread.autonomy = true;
  const MissionConfig config = without(route_config(fidelity, seed), unread);
  const auto mission = prepare(config, scenes());
  EXPECT_TRUE(mission.ok()) << (mission.ok() ? "" : mission.error().str());
  MemoryRecorder rows;
  RunParts parts;
  parts.tape = &tape;
  parts.recorder = &rows;
  parts.omissions = &unread;
  const auto run = run_mission(config, *mission, nullptr, std::move(parts));
  EXPECT_TRUE(run.ok()) << (run.ok() ? "" : run.error().str());
  Errors out;
  for (const NavRow& row : rows.nav) {
    const Eigen::Vector3d e = estimate_error(row).position_W_m;
    out.rms_m += e.squaredNorm();
    out.horizontal_m += e.head<2>().squaredNorm();
    out.largest_m = std::max(out.largest_m, e.norm());
  }
  const auto count = static_cast<double>(rows.nav.size());
  out.rms_m = std::sqrt(out.rms_m / count);
  out.horizontal_m = std::sqrt(out.horizontal_m / count);
  return out;
}

double median_of_three(double a, double b, double c) {
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

/// Places once a second. Not tape_hash(): sines differ in their last bit from processor to processor.
std::string hash_to_a_tenth_of_a_millimetre(const Tape& tape) {
  std::string text;
  for (std::size_t i = 0; i < tape.nodes.size(); i += 100) {
    for (const double x : tape.nodes[i].motion.X_WB.p) text += std::to_string(std::llround(1e4 * x)) + ' ';
  }
  return sha256_hex(text);
}

Tape route_tape() {
  const MissionConfig config = route_config("low", 1);
  const auto mission = prepare(config, scenes());
  EXPECT_TRUE(mission.ok()) << (mission.ok() ? "" : mission.error().str());
  auto tape = drive_route(config, *mission);
  EXPECT_TRUE(tape.ok()) << (tape.ok() ? "" : tape.error().str());
  return *std::move(tape);
}

TEST(FiltersOnATape, AVehiclesFilterIsThreeTimesAsNear) {
  const Tape tape = route_tape();
  // Another motion is another comparison: who changes vehicle, route or follower measures anew.
  EXPECT_EQ(hash_to_a_tenth_of_a_millimetre(tape), "501b5e1a03f684ecadeb23d1b0346a06cf7fe4e3dc94ae4d83af07659c90b333");
  EXPECT_LT(3.0 * errors_of("high_aided", 101, tape).rms_m, errors_of("high", 101, tape).rms_m);
}

TEST(FiltersOnATapeNightly, AVehiclesFilterKeepsWithinAMetreAndAHalf) {
  const Tape tape = route_tape();
  Errors naive[3], vehicle[3];
  for (int k = 0; k < 3; ++k) {
    naive[k] = errors_of("high", 101 + k, tape);
    vehicle[k] = errors_of("high_aided", 101 + k, tape);
    EXPECT_LT(3.0 * vehicle[k].rms_m, naive[k].rms_m) << k;
  }
  const auto median = [](const Errors(&of)[3], double Errors::*figure) {
    return median_of_three(of[0].*figure, of[1].*figure, of[2].*figure);
  };
  EXPECT_LT(median(vehicle, &Errors::rms_m), 1.5);
  EXPECT_LT(median(vehicle, &Errors::horizontal_m), 1.0);
  EXPECT_LT(median(vehicle, &Errors::largest_m), 5.0);
  EXPECT_GT(median(naive, &Errors::rms_m), 3.0) << "as good as that, there is nothing to tell them apart by";
}

}  // namespace
}  // namespace canyon::mission::testing
