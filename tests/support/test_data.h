#pragma once

#include <string>

#include <gtest/gtest.h>

namespace canyon::testing {

/// Path of a file of the shared real recordings, for example "gnss/orbit_2010_182/brdc1820.10n". They are looked for in
/// CANYON_TEST_DATA, else in ../shared/data beside the checkout. Empty if there is no such folder at all; if the folder
/// is there but the file is not, the running test fails.
std::string data_file(const std::string& relative);

}  // namespace canyon::testing

/// Skips the running test, counted in the closing summary, when the folder of real recordings does not exist.
#define CANYON_REAL_DATA(variable, relative)                           \
  const std::string variable = ::canyon::testing::data_file(relative); \
  if (variable.empty()) GTEST_SKIP() << "real recordings not found (set CANYON_TEST_DATA): " << relative
