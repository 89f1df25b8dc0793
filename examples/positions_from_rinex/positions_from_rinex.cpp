// positions_from_rinex OBSERVATIONS NAVIGATION: position (ECEF, m) and GDOP of every epoch that has one.
#include <cstdio>

#include "canyon/gnss/rinex/navigation/navigation_file.h"
#include "canyon/gnss/rinex/observation/observation_file.h"
#include "canyon/gnss/single_point/single_point.h"

namespace {

canyon::Status print_positions(const char* observation_file, const char* navigation_file) {
  using namespace canyon::gnss;
  CANYON_TRY(const ObservationFile observations, read_observation_file(observation_file));
  CANYON_TRY(const NavigationData navigation, read_navigation_files({navigation_file}));
  const SinglePointConfig config;
  const auto constellation = make_broadcast(navigation, {.systems = config.systems});
  CANYON_TRY(const auto solved, solve_observations(observations, {*constellation, navigation}, config));
  for (const SinglePointEpoch& epoch : solved.epochs) {
    if (epoch.fix.status == canyon::FixStatus::kNone) continue;
    const Eigen::Vector3d& p_E = epoch.fix.p_A_E;
    std::printf("%s  %.4f %.4f %.4f  GDOP %.2f\n", epoch.fix.t.iso(3).c_str(), p_E.x(), p_E.y(), p_E.z(),
                epoch.fix.dop.gdop);
  }
  std::fprintf(stderr, "%d of %zu epochs solved\n", solved.solved(), solved.epochs.size());
  return canyon::Ok{};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s OBSERVATIONS NAVIGATION\n", argv[0]);
    return 2;
  }
  const canyon::Status status = print_positions(argv[1], argv[2]);
  if (!status.ok()) std::fprintf(stderr, "%s\n", status.error().str().c_str());
  return status.ok() ? 0 : 2;
}
