#include "canyon/core/files/zip_file.h"

#include <algorithm>
#include <cctype>
#include <cstdint>

#include <zlib.h>

#include "canyon/core/files/files.h"

namespace canyon {
namespace {

std::uint32_t little(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t k = count; k-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

bool ends_with(std::string_view name, std::string_view ending) {
  return name.size() >= ending.size() &&
         std::equal(ending.begin(), ending.end(), name.end() - static_cast<std::ptrdiff_t>(ending.size()),
                    [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); });
}

}  // namespace

Result<std::string> read_zip_member(const std::string& path, std::string_view ending) {
  CANYON_TRY(const std::string archive, read_text_file(path));
  const auto broken = [&] { return Error{path, 0, "", "not a whole ZIP archive", "a ZIP archive"}; };
  constexpr std::size_t kEnd = 22, kEntry = 46, kLocal = 30;
  const std::size_t tail = archive.rfind("PK\x05\x06");
  if (tail == std::string::npos || tail + kEnd > archive.size()) return broken();
  std::size_t at = little(archive, tail + 16, 4);
  for (std::uint32_t n = little(archive, tail + 10, 2); n > 0; --n) {
    if (at + kEntry > archive.size() || archive.compare(at, 4, "PK\x01\x02") != 0) return broken();
    const std::uint32_t method = little(archive, at + 10, 2), packed = little(archive, at + 20, 4);
    const std::uint32_t size = little(archive, at + 24, 4), name_length = little(archive, at + 28, 2);
    if (at + kEntry + name_length > archive.size()) return broken();
    const std::string name = archive.substr(at + kEntry, name_length);
    const std::size_t local = little(archive, at + 42, 4);
    at += kEntry + name_length + little(archive, at + 30, 2) + little(archive, at + 32, 2);
    if (!ends_with(name, ending)) continue;
    if (local + kLocal > archive.size()) return broken();
    const std::size_t begin = local + kLocal + little(archive, local + 26, 2) + little(archive, local + 28, 2);
    if (begin + packed > archive.size()) return broken();
    if (method == 0) return archive.substr(begin, packed);
    if (method != 8)
      return Error{path, 0, name, "packed in a way that is not known", "a member that is stored or deflated"};
    // No file of this kind shrinks by more than a thousand times.
    if (size > 1000ull * packed + 1000ull) return broken();
    std::string out(size, '\0');
    z_stream stream{};
    CANYON_CHECK(inflateInit2(&stream, -MAX_WBITS) == Z_OK, "zlib could not be started");
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(archive.data() + begin));
    stream.avail_in = packed;
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = size;
    const int status = inflate(&stream, Z_FINISH);
    inflateEnd(&stream);
    if (status != Z_STREAM_END || stream.total_out != size) return broken();
    return out;
  }
  return Error{path, 0, "", "holds no *" + std::string(ending), "an archive with such a file"};
}

}  // namespace canyon
