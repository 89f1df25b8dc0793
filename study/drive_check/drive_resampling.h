#pragma once

#include <cstdint>
#include <vector>

#include "canyon/study/drive_check/drive_figures.h"

namespace canyon::study {

/// Errors of a drive last for seconds, so what is drawn anew are blocks of it.
inline constexpr double kDriveBlock_s = 20.0;

/// Block bootstrap (Kunsch 1989): the figures of `count` drives, each made of as many blocks of 20 s as the drive has,
/// drawn from it with replacement; what is two epochs apart in a block stays so, and no pair reaches from one block
/// into another. Blocks begin at the first epoch; the last may be shorter. Nothing of a drive without epochs.
std::vector<DriveFigures> resampled_figures(const std::vector<DriveEpoch>& epochs, const std::vector<DriveFix>& fixes,
                                            int count, std::uint64_t seed);

/// Of the block that an instant falls into.
int drive_block(GpsTime t, GpsTime start);

}  // namespace canyon::study
