#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "canyon/core/result.h"

struct evp_md_ctx_st;  // OpenSSL's

namespace canyon {

/// SHA-256 of bytes that come piece by piece, as sha256_hex() of all of them.
class Sha256 {
 public:
  Sha256();
  void add(std::string_view bytes);
  /// Once, of all that was added.
  std::string hex() &&;

 private:
  std::unique_ptr<evp_md_ctx_st, void (*)(evp_md_ctx_st*)> context_;
};

/// SHA-256 of a file of any size, as sha256_hex() of its bytes, which are not held.
Result<std::string> sha256_of_file(const std::string& path);

}  // namespace canyon
