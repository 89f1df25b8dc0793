#pragma once

#include <span>

namespace canyon::study {

/// A value that a run which drove by itself may leave undefined: null in JSON, an empty field in CSV. Everything else
/// in its files is a finite number, or a word. docs/results.md lists these rows.
struct MayBeAbsent {
  const char* file;    ///< "summary.json", "manifest.json", or of epochs/RUN_gnss.csv "gnss"
  const char* values;  ///< columns or keys, with commas between
  const char* when;    ///< column of the same row, or key of the same object, that says so; "": at any time
  const char* is;  ///< what it then reads; "": nothing (null); "=KEY": the same as that other one; "1,2": one of these
  const char* why;
};

std::span<const MayBeAbsent> may_be_absent();

}  // namespace canyon::study
