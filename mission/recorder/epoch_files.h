#pragma once

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/messages.h"
#include "canyon/inertial/aiding/barometer.h"
#include "canyon/inertial/aiding/magnetometer.h"
#include "canyon/inertial/aiding/odometer.h"
#include "canyon/mission/recorder/csv_writer.h"
#include "canyon/mission/recorder/rows.h"

namespace canyon::mission {

/// What the columns of a run refer to.
struct RowPlace {
  LocalFrame frame;
  GpsTime start;
  bool registers = false;  ///< else the errors of registered keyframes are undefined
};

/// Columns and rows of epochs/RUN_*.csv (docs/results.md).
extern const char *const kNavColumns, *const kNavCovarianceColumns, *const kGnssColumns, *const kSatelliteColumns,
                                                                                             *const kKeyframeColumns;
void write(CsvWriter& csv, const NavRow& row, const RowPlace& run);
/// Of [position; velocity; attitude], along and about W's axes, m, m/s and rad: the upper triangle row by row, of a row
/// that has a covariance.
void write_covariance(CsvWriter& csv, const NavRow& row, const RowPlace& run);
void write(CsvWriter& csv, const GnssRow& row, const RowPlace& run);
void write_satellites(CsvWriter& csv, const GnssRow& row, const RowPlace& run);
void write(CsvWriter& csv, const KeyframeRow& row, const RowPlace& run);

/// What a filter is given, to the last bit: messages of IMU, odometer, barometer and magnetometer, of the last three
/// with their truth records behind them, fixes in E with their covariances, and corrected ranges.
extern const char *const kImuColumns, *const kOdometerColumns, *const kBarometerColumns, *const kMagnetometerColumns,
                                                                                             *const kFixColumns,
                                                                                                 *const kRangeColumns;
void write(CsvWriter& csv, const ImuSample& sample, const RowPlace& run);
void write(CsvWriter& csv, const inertial::Odometer::Reading& reading, const RowPlace& run);
void write(CsvWriter& csv, const inertial::Barometer::Reading& reading, const RowPlace& run);
void write(CsvWriter& csv, const inertial::Magnetometer::Reading& reading, const RowPlace& run);
void write_fix(CsvWriter& csv, const GnssRow& row, const RowPlace& run);
/// One row per satellite.
void write_ranges(CsvWriter& csv, const GnssRow& row, const RowPlace& run);

}  // namespace canyon::mission
