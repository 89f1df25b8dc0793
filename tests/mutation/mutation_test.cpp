#include <cstdlib>
#include <iostream>
#include <string_view>

#include <gtest/gtest.h>

#include "canyon/tests/mutation/format.h"
#include "canyon/tests/mutation/survival.h"

/// Every reader, given damaged files: success or one line that says what is wrong, no signal, not over 20 s or 2 GB.
namespace canyon::testing {
namespace {

/// Of each format. The nightly form has the short one's variants, too.
constexpr std::uint64_t kShort = 20, kFull = 600;

void expect_none(const Format& format, const std::vector<Finding>& found) {
  for (const Finding& f : found)
    ADD_FAILURE() << format.name << ", variant " << f.variant << " (" << f.how << "): " << f.what
                  << "\nagain, alone: canyon_mutation_tests --variant=" << format.name << ":" << f.variant;
}

class Mutation : public ::testing::TestWithParam<Format> {};
using MutationNightly = Mutation;

TEST_P(Mutation, WholeFilesAreRead) {
  expect_none(GetParam(), findings_of_seeds(GetParam()));
}

TEST_P(Mutation, DamagedFilesAreReadOrRefused) {
  expect_none(GetParam(), findings(GetParam(), 0, kShort));
}

TEST_P(MutationNightly, DamagedFilesAreReadOrRefused) {
  expect_none(GetParam(), findings(GetParam(), 0, kFull));
}

std::string name_of(const ::testing::TestParamInfo<Format>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Readers, Mutation, ::testing::ValuesIn(formats()), name_of);
INSTANTIATE_TEST_SUITE_P(Readers, MutationNightly, ::testing::ValuesIn(formats()), name_of);

int reproduce_one(const std::string& which) {
  const std::size_t colon = which.find(':');
  if (colon == std::string::npos) {
    std::cerr << "--variant=FORMAT:NUMBER\n";
    return 2;
  }
  for (const Format& format : formats())
    if (format.name == which.substr(0, colon))
      return reproduce(format, std::strtoull(which.c_str() + colon + 1, nullptr, 10), "mutation-" + which);
  std::cerr << "no format \"" << which.substr(0, colon) << "\"\n";
  return 2;
}

}  // namespace
}  // namespace canyon::testing

/// Beside gtest's own options: --variant=FORMAT:NUMBER reads one damaged file again, and leaves it in a folder here.
int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  constexpr std::string_view kVariant = "--variant=";
  for (int i = 1; i < argc; ++i)
    if (std::string_view(argv[i]).substr(0, kVariant.size()) == kVariant)
      return canyon::testing::reproduce_one(argv[i] + kVariant.size());
  return RUN_ALL_TESTS();
}
