#pragma once

#include "canyon/gnss/rinex/observation/observation_file.h"
#include "canyon/gnss/rinex/text_lines.h"

namespace canyon::gnss {

/// Takes in header records, from the top of a file or from inside it.
class ObservationHeaderReader {
 public:
  explicit ObservationHeaderReader(const std::string& file) : file_(file) {}

  /// First line: version and type. `number` is its line for messages.
  Status first_line(std::string_view line, int number);
  /// Any further line. Labels that do not matter to Canyon are passed over.
  Status line(std::string_view line, int number);
  /// To be called at the end of the header, and of each block of header records inside the file.
  Status finish(int number);

  const ObservationHeader& header() const { return header_; }
  bool version3() const { return header_.version >= 3.0; }
  /// Codes in force. RINEX 2 has one list for all systems, converted for each.
  const ObservationCodes& codes() const { return codes_; }
  /// How many numbers a satellite has, also of systems that Canyon does not know.
  std::size_t count(char system_letter) const;
  /// What the numbers of a system must be divided by, in the order of its codes.
  const std::vector<double>& scale(GnssSystem system) const { return scale_[static_cast<std::size_t>(system)]; }

 private:
  Status types3(std::string_view line, int number);
  Status types2(std::string_view line, int number);
  Status scale_factor(std::string_view line, int number);
  Status glonass_slots(std::string_view line, int number);
  Error cannot_read(const char* label, int number, const char* expected) const;

  const std::string& file_;
  ObservationHeader header_;
  ObservationCodes codes_;
  std::array<std::vector<double>, 6> scale_;
  std::array<std::size_t, 26> counts_{};
  std::vector<std::string> names2_;  // of RINEX 2
  std::size_t expected2_ = 0;
  char letter_ = ' ';  // system that a continuation line of types belongs to
  char scale_letter_ = ' ';
  std::size_t listed_ = 0;
  double scale_value_ = 1.0;
};

}  // namespace canyon::gnss
