#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "canyon/fusion/timeline/filter_timeline.h"
#include "canyon/tests/fusion/driven_truth.h"

/// One winding drive with a tactical unit and fixes of 1 m twice a second, and what receivers and drivers do to them.
namespace canyon::testing {}
namespace canyon::fusion::testing {
using namespace canyon::testing;  // so that testing:: is both

using canyon::testing::DrivenTruth;

/// 1 m per axis, twice a second.
inline constexpr double kSigma_m = 1.0;
inline constexpr int kSamplesPerFix = 50;

struct Worst {
  double off_m = 0.0;    ///< largest error of position after the first 30 s
  double final_m = 0.0;  ///< at the end
  Incidents incidents;
};

/// What is made of each sample and fix on its way: what is delivered of it, in that order.
struct Fault {
  std::function<std::vector<ImuSample>(int k, const ImuSample&)> imu = [](int, const ImuSample& s) {
    return std::vector<ImuSample>{s};
  };
  std::function<std::vector<GnssFix>(int k, const GnssFix&)> fix = [](int, const GnssFix& f) {
    return std::vector<GnssFix>{f};
  };
};

DrivenTruth tactical(double heading_rad);
ErrorStateFilter started(const DrivenTruth& truth, const std::string& keys);

/// What else the vehicle carries.
enum class Carries {
  kUnitAndReceiver,
  kWheelsToo  ///< ticks ten times a second, and the fixes' velocities (0.05 m/s)
};
Worst drive(const std::string& keys, const Fault& fault, double seconds = 180.0,
            Carries carries = Carries::kUnitAndReceiver);

/// What becomes of a filter that stands without a timeline: it refuses what is no sample of its own next interval, and
/// what is no number, and with that the run ends.
enum class Stamps {
  kAsTheyCome,
  kCounted  ///< by a driver that takes each sample and fix for the next one, whatever its stamp says
};
struct Bare {
  Worst worst;                    ///< until then
  std::optional<double> ended_s;  ///< after the start; nothing: it took everything
  std::string why;
};
Bare drive_bare(const std::string& keys, const Fault& fault, Stamps stamps,
                Carries carries = Carries::kUnitAndReceiver);

/// One fix in five is 100 m off, 1-sigma per axis.
Fault one_in_five_anywhere();
/// From the 60th to the 70th second the last fix again and again, with new stamps.
Fault frozen_for_ten_seconds();
/// Stamped 200 ms after it held; `seconds` is the length of the drive.
Fault late_by_200_ms(double seconds = 180.0);
/// Each sample twice, each fix three times.
Fault all_twice();
/// Of each hundred samples two come in the wrong order.
Fault two_in_reverse();
/// Now and then a rate or a force is no number, or what a fix says is none.
Fault not_a_number();
/// So many samples with fixes that wander 200 m off, then good ones.
Fault bad_until(int samples);

}  // namespace canyon::fusion::testing
