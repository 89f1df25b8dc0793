#pragma once

#include "canyon/core/stress_rows.h"

/// Where the cases of state blocks are collected.
namespace canyon::fusion {

/// Rows of the one mechanism that these cases have in common.
inline StressRows block_rows() {
  StressRows rows;
  rows.of({StressGroup::kData, "state blocks by their parameters",
           "a sigma of another unit, a density of half the process, a row for a column",
           "each by what its keys and the unit's sheet say, whole states by hand: roundings", "of the bound"});
  return rows;
}

}  // namespace canyon::fusion
