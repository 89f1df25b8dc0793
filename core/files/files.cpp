#include "canyon/core/files/files.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <system_error>

#include <openssl/evp.h>
#include <zlib.h>

#include "canyon/core/check.h"
#include "canyon/core/files/file_hash.h"
#include "canyon/core/files/file_writer.h"
#include "canyon/core/process/progress.h"

namespace canyon {
namespace {

Error file_error(const std::string& path, std::string what, std::string expected = {}, int exit_code = 2) {
  Error error;
  error.file = path;
  error.what = std::move(what);
  error.expected = std::move(expected);
  error.exit_code = exit_code;
  return error;
}

std::string system_message(int code) {
  return std::system_category().message(code);
}

/// Text shrinks to a fiftieth at best; a file that grows beyond both of these was made to fill memory.
constexpr std::size_t kMostGrowth = 200, kAlwaysAllowed = std::size_t{1} << 26;

/// Unpacks all members of a gzip file.
Result<std::string> gunzip(const std::string& path, const std::string& packed) {
  z_stream stream = {};
  CANYON_CHECK(inflateInit2(&stream, 16 + MAX_WBITS) == Z_OK, "zlib could not be started");
  struct End {
    z_stream& stream;
    ~End() { inflateEnd(&stream); }
  } const end{stream};

  std::string text;
  std::array<char, 1 << 16> buffer;
  std::size_t fed = 0;
  int status = Z_OK;
  while (true) {
    throw_if_cancelled();
    if (stream.avail_in == 0 && fed < packed.size()) {
      const std::size_t piece = std::min<std::size_t>(packed.size() - fed, 1u << 30);
      // zlib's interface predates const; it does not write to its input.
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + fed));
      stream.avail_in = static_cast<uInt>(piece);
      fed += piece;
    }
    stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
    stream.avail_out = static_cast<uInt>(buffer.size());
    throw_if_cancelled();
    status = inflate(&stream, Z_NO_FLUSH);
    text.append(buffer.data(), buffer.size() - stream.avail_out);
    if (text.size() > std::max(kAlwaysAllowed, kMostGrowth * packed.size()))
      return file_error(path, "unpacks to more than " + std::to_string(kMostGrowth) + " times its size", "a text file");
    if (status == Z_STREAM_END) {
      if (stream.avail_in == 0 && fed == packed.size()) return text;
      inflateReset(&stream);  // another member follows
    } else if (status != Z_OK) {
      const bool truncated = status == Z_BUF_ERROR;
      return file_error(path, truncated ? "gzip data ends too early" : "gzip data is damaged", "a complete gzip file");
    }
  }
}

/// Calls take(piece) for what the file holds, one piece after the other.
template <class Take>
Status read_pieces(const std::string& path, const Take& take) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) return file_error(path, "is a directory", "a file");
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) return file_error(path, "cannot be read (" + system_message(errno) + ")", "a readable file");
  std::array<char, 1 << 16> buffer;
  while (in.read(buffer.data(), buffer.size()) || in.gcount() > 0) {
    throw_if_cancelled();
    take(std::string_view(buffer.data(), static_cast<std::size_t>(in.gcount())));
  }
  if (in.bad()) return file_error(path, "cannot be read (" + system_message(errno) + ")", "a readable file");
  return Ok{};
}

}  // namespace

Result<std::string> read_text_file(const std::string& path) {
  std::string text;
  CANYON_TRY_STATUS(read_pieces(path, [&text](std::string_view piece) { text += piece; }));
  return text;
}

Result<std::string> read_text_or_gzip_file(const std::string& path) {
  CANYON_TRY(std::string bytes, read_text_file(path));
  const bool gzip = bytes.compare(0, 2, "\x1f\x8b") == 0;
  if (!gzip) return bytes;
  return gunzip(path, bytes);
}

Result<FileWriter> FileWriter::create(const std::string& path) {
  errno = 0;
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  if (!out) return file_error(path, "cannot be written (" + system_message(errno) + ")", "a writable place");
  return FileWriter(path, std::move(out));
}

Status FileWriter::write(std::string_view bytes) {
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (out_) return Ok{};
  return file_error(path_, "cannot be written to the end (" + system_message(errno) + ")", "space on the disk", 1);
}

Status FileWriter::close() {
  out_.close();
  return write({});
}

Status write_text_file(const std::string& path, std::string_view text) {
  CANYON_TRY(FileWriter out, FileWriter::create(path));
  CANYON_TRY_STATUS(out.write(text));
  return out.close();
}

namespace {

std::string hexadecimal(const unsigned char* digest) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (int i = 0; i < 32; ++i) {
    text += kDigits[digest[i] >> 4];
    text += kDigits[digest[i] & 15];
  }
  return text;
}

}  // namespace

Sha256::Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
  CANYON_CHECK(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1, "no SHA-256");
}

void Sha256::add(std::string_view bytes) {
  CANYON_CHECK(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1, "no SHA-256");
}

std::string Sha256::hex() && {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  CANYON_CHECK(EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr) == 1, "no SHA-256");
  return hexadecimal(digest.data());
}

Result<std::string> sha256_of_file(const std::string& path) {
  Sha256 hash;
  CANYON_TRY_STATUS(read_pieces(path, [&hash](std::string_view piece) { hash.add(piece); }));
  return std::move(hash).hex();
}

std::string sha256_hex(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes);
  return std::move(hash).hex();
}

}  // namespace canyon
