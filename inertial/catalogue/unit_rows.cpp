#include "canyon/inertial/catalogue/sheet_rows.h"

namespace canyon::inertial {
namespace {

constexpr UnitRow kUnitRows[] = {
    {"reference_temperature_c",
     "reference_temperature_source",
     &UnitSheet::reference_temperature_c,
     {-100, 200},
     1.0,
     &UnitFigures::reference_temperature_c,
     UnitRow::kHasDefault,
     "where the other figures hold"},
    {"latency_ms",
     "latency_source",
     &UnitSheet::latency_ms,
     {0, 1e3},
     1e-3,
     &UnitFigures::latency_s,
     UnitRow::kOptional,
     "from the motion to the stamp of the sample"},
    {"clock_skew_ppm",
     "clock_skew_source",
     &UnitSheet::clock_skew_ppm,
     {0, 5e4},
     1e-6,
     &UnitFigures::clock_skew,
     UnitRow::kOptional,
     "error of the unit's clock, 1-sigma"},
    {"clock_jitter_us",
     "clock_jitter_source",
     &UnitSheet::clock_jitter_us,
     {0, 1e5},
     1e-6,
     &UnitFigures::clock_jitter_s,
     UnitRow::kOptional,
     "of each stamp, 1-sigma"},
    {"loss_percent",
     "loss_source",
     &UnitSheet::loss_percent,
     {0, 24},
     1e-2,
     &UnitFigures::loss_share,
     UnitRow::kOptional,
     "samples that do not arrive"},
    {"loss_length",
     "loss_length_source",
     &UnitSheet::loss_length,
     {1, 1000},
     1.0,
     &UnitFigures::loss_length,
     UnitRow::kHasDefault,
     "samples lost together"},
};

}  // namespace

std::span<const UnitRow> unit_rows() {
  return kUnitRows;
}

}  // namespace canyon::inertial
