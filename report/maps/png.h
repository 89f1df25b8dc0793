#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/report/draw/theme.h"

namespace canyon::report {

/// A PNG (ISO/IEC 15948) of palette indices, row by row from the top; 4 bits a pixel for up to 16 colours, else 8.
/// Every index must be below palette.size(), which lies in [1, 256].
std::string write_indexed_png(std::size_t width, std::size_t height, std::span<const std::uint8_t> indices,
                              const std::vector<Rgba>& palette);

/// RFC 4648 base64 with padding.
std::string base64(std::string_view bytes);

/// "data:image/png;base64,..."
std::string png_data_uri(std::string_view png);

}  // namespace canyon::report
