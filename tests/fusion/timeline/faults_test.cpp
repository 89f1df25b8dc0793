// What real receivers and drivers do to a filter, with protection and beside it without.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "canyon/fusion/stress/at_rest.h"
#include "canyon/tests/fusion/timeline/faulty_drive.h"

namespace canyon::fusion {
namespace {

using namespace testing;

void print(const char* what, const Worst& bare, const Worst& guarded) {
  std::printf("%s: at most %.1f m off, guarded %.2f m; %s\n", what, bare.off_m, guarded.off_m,
              guarded.incidents.text().c_str());
}

const std::string kBare = "filter = \"naive\"";
/// A constraint that keeps the place while fixes are refused, and tails that outliers do not pull.
const std::string kGuarded =
    "states = [\"biases\"]\nmeasurements = [\"position\", \"non_holonomic\"]\nacceptance = \"student_t\"";
/// Three sigma of the filter with sound fixes, three axes: 0.5 m each after filtering.
constexpr double kSound_m = 3.0;

TEST(Faults, NoneIsWhatItIsMeasuredAgainst) {
  const Worst bare = drive(kBare, {}), guarded = drive(kGuarded, {});
  print("no fault", bare, guarded);
  EXPECT_LT(bare.off_m, kSound_m);
  EXPECT_LT(guarded.off_m, kSound_m);
  EXPECT_EQ(guarded.incidents.text(), "");
}

TEST(Faults, OneFixInFiveIsAnywhere) {
  const Fault fault = one_in_five_anywhere();
  const Worst bare = drive(kBare, fault);
  for (const auto& row : acceptance_models()) {
    const std::string keys =
        "states = [\"biases\"]\nmeasurements = [\"position\", \"non_holonomic\"]\ngate_sigma = 4\n"
        "acceptance = \"" +
        std::string(row.name) + "\"";
    std::printf("  %s: %.2f m\n", row.name, drive(keys, fault).off_m);
  }
  const Worst guarded = drive(kGuarded, fault);
  print("20 % outliers of 100 m", bare, guarded);
  EXPECT_GT(bare.off_m, 10.0 * kSound_m);
  EXPECT_LT(guarded.off_m, kSound_m);
}

TEST(Faults, FixesFreezeForTenSeconds) {
  const Fault bare_fault = frozen_for_ten_seconds();
  // The bare filter is not told: nothing in a fix says that it is old.
  DrivenTruth truth = tactical(0.5);
  ErrorStateFilter filter = started(truth, kBare);
  Worst bare;
  for (int k = 1; k <= 9000; ++k) {
    filter.predict(truth.step());
    if (k % kSamplesPerFix == 0) filter.update(bare_fault.fix(k, truth.fix(Eigen::Vector3d::Zero(), kSigma_m)).front());
    bare.off_m = std::max(bare.off_m, (filter.nav_state().p_EU_E - truth.state().p_EU_E).norm());
  }
  const Worst guarded = drive(kGuarded, frozen_for_ten_seconds());
  print("10 s frozen", bare, guarded);
  EXPECT_GT(bare.off_m, 5.0 * kSound_m);
  EXPECT_LT(guarded.off_m, kSound_m);
  EXPECT_EQ(guarded.incidents.count(Trouble::kFrozen), 19);  // the first of twenty is one
}

TEST(Faults, LatencyNobodyDeclared) {
  const Fault fault = late_by_200_ms();
  const Worst bare = drive(kBare, fault);
  const Worst guarded = drive(
      "states = [\"biases\", \"time_offset\"]\nmeasurements = [\"position\", \"non_holonomic\"]\n"
      "acceptance = \"student_t\"\ntime_offset_sigma_s = 0.2",
      fault);
  print("200 ms of latency", bare, guarded);
  EXPECT_LT(guarded.final_m, kSound_m);
  EXPECT_LT(guarded.off_m, bare.off_m);
}

/// `naive` on its own, without a timeline before it, and what a driver that ignores stamps makes of it.
void print_bare(const char* what, const Fault& fault) {
  for (const Stamps stamps : {Stamps::kAsTheyCome, Stamps::kCounted}) {
    const Bare bare = drive_bare(kBare, fault, stamps);
    std::printf("  %s, %s: ", what, stamps == Stamps::kAsTheyCome ? "stamps as they come" : "counted");
    if (bare.ended_s)
      std::printf("ends after %.2f s: %s\n", *bare.ended_s, bare.why.c_str());
    else
      std::printf("at most %.1f m off, %.2f m at the end\n", bare.worst.off_m, bare.worst.final_m);
  }
}

TEST(Faults, SamplesAndFixesTwiceInReverseAndNotANumber) {
  const Worst none = drive(kGuarded, {}), a = drive(kGuarded, all_twice()), b = drive(kGuarded, two_in_reverse()),
              c = drive(kGuarded, not_a_number());
  std::printf("guarded: all twice %.2f m, in reverse %.2f m, not a number %.2f m\n", a.off_m, b.off_m, c.off_m);
  EXPECT_EQ(a.off_m, none.off_m);  // nothing counts twice
  EXPECT_EQ(a.incidents.count(Trouble::kDuplicate), 18000 + 2 * 360);
  EXPECT_EQ(b.incidents.count(Trouble::kReversed), 180);
  EXPECT_EQ(b.incidents.count(Trouble::kGap), 180);
  EXPECT_LT(b.off_m, kSound_m);
  EXPECT_EQ(c.incidents.count(Trouble::kNotFinite), 180 + 90 + 60 - 30);
  EXPECT_LT(c.off_m, kSound_m);
}

TEST(Faults, WithoutATimelineTheFilterEndsOrIsLedAstray) {
  print_bare("all twice", all_twice());
  print_bare("in reverse", two_in_reverse());
  print_bare("not a number", not_a_number());
  // The very first of each ends it.
  EXPECT_EQ(drive_bare(kBare, all_twice(), Stamps::kAsTheyCome).ended_s, 0.01);
  EXPECT_EQ(drive_bare(kBare, two_in_reverse(), Stamps::kAsTheyCome).ended_s, 0.02);
  for (const Stamps stamps : {Stamps::kAsTheyCome, Stamps::kCounted})
    EXPECT_EQ(drive_bare(kBare, not_a_number(), stamps).ended_s, 0.07);
  // Everything twice is a vehicle that moves twice as far.
  const Bare twice = drive_bare(kBare, all_twice(), Stamps::kCounted);
  EXPECT_FALSE(twice.ended_s);
  EXPECT_GT(twice.worst.off_m, 5.0 * kSound_m);
}

std::string with_acceptance(const char* acceptance) {
  return "states = [\"biases\"]\nmeasurements = [\"position\", \"non_holonomic\"]\ngate_sigma = 4\n"
         "gate_recovery_s = 5\nacceptance = \"" +
         std::string(acceptance) + "\"";
}

TEST(Faults, AnHourOfBadFixesIsForgottenInTenSeconds) {
  const Worst worst = drive(with_acceptance("gate"), bad_until(360000), 3610.0);
  std::printf("an hour of bad fixes: %.1f m off at most, %.2f m ten seconds after\n", worst.off_m, worst.final_m);
  EXPECT_LT(worst.final_m, kSound_m);
}

/// The others trust what has lasted for longer: five minutes here. No way back is as quick as the gate's: where no
/// velocity comes with the fixes they are judged by the filter's own motion, which has been led astray as well.
TEST(Faults, OthersForgetSlowly) {
  for (const auto& row : acceptance_models()) {
    const double soon_m = drive(with_acceptance(row.name), bad_until(30000), 310.0).final_m,
                 late_m = drive(with_acceptance(row.name), bad_until(30000), 600.0).final_m;
    std::printf("  %s: %.2f m off after 10 s, %.2f m after 5 minutes\n", row.name, soon_m, late_m);
    EXPECT_LT(late_m, soon_m) << row.name;
  }
}

}  // namespace
}  // namespace canyon::fusion
