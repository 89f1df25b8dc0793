#pragma once

#include <span>

#include "canyon/core/config/config.h"
#include "canyon/inertial/catalogue.h"
#include "canyon/inertial/errors/error_figures.h"

namespace canyon::inertial {

/// One figure of a sheet: its keys, what it may be, and where it goes in SI.
template <class Sheet, class Figures>
struct SheetRow {
  const char* key;
  const char* source_key;
  Figure Sheet::*figure;
  Range range;
  double unit;                                           ///< one of the sheet's units in SI
  double Figures::*si;                                   ///< null: no link takes it
  enum Need { kRequired, kOptional, kHasDefault } need;  ///< what is missing is: an error; zero; the default
  const char* doc;
};
using GyroRow = SheetRow<GyroSheet, TriadFigures>;
using AccelRow = SheetRow<AccelSheet, TriadFigures>;
using UnitRow = SheetRow<UnitSheet, UnitFigures>;

/// All figures of a gyroscope's, an accelerometer's and a unit's sheet, in the order of docs and files.
std::span<const GyroRow> gyro_rows();
std::span<const AccelRow> accel_rows();
std::span<const UnitRow> unit_rows();

}  // namespace canyon::inertial
