#include "canyon/core/files/files.h"

#include <fstream>

#include <gtest/gtest.h>
#include <zlib.h>

#include "canyon/core/random/random.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon {
namespace {

using testing::TemporaryFolder;

std::string gzip(const std::string& text) {
  z_stream stream = {};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(deflateBound(&stream, text.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

// Some kilobytes that unpack to very much: an error, not all of the memory.
TEST(GzipFile, OneThatFillsMemoryIsAnError) {
  const TemporaryFolder folder;
  const std::string file = folder.file("bomb.gz");
  ASSERT_TRUE(write_text_file(file, gzip(std::string(70'000'000, '0'))).ok());
  EXPECT_EQ(read_text_or_gzip_file(file).error().str(),
            file + ": unpacks to more than 200 times its size, expected a text file");
}

std::string long_text() {
  const RandomStream random(1, "test.text");
  std::string text;
  for (std::uint64_t i = 0; i < 300'000; ++i)
    text += static_cast<char>(static_cast<unsigned char>(random.uniform(0.0, 256.0, 0, i)));
  return text;
}

TEST(TextFile, RoundTripOfAnyBytes) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.bin");
  for (const std::string& text : {std::string(), std::string("a\r\nb\0c\n", 7), long_text()}) {
    ASSERT_TRUE(write_text_file(file, text).ok());
    const auto back = read_text_file(file);
    ASSERT_TRUE(back.ok());
    EXPECT_EQ(*back, text);
    EXPECT_EQ(*read_text_or_gzip_file(file), text);
  }
}

TEST(TextFile, ErrorsWordForWord) {
  const TemporaryFolder folder;
  const std::string missing = folder.file("missing.toml");
  EXPECT_EQ(read_text_file(missing).error().str(),
            missing + ": cannot be read (No such file or directory), expected a readable file");
  EXPECT_EQ(read_text_file(folder.path().string()).error().str(),
            folder.path().string() + ": is a directory, expected a file");
  const std::string nowhere = folder.file("no/folder.txt");
  EXPECT_EQ(write_text_file(nowhere, "x").error().str(),
            nowhere + ": cannot be written (No such file or directory), expected a writable place");
  EXPECT_EQ(write_text_file(nowhere, "x").error().exit_code, 2);
}

TEST(TextFile, AFullDiskIsAnErrorOfTheComputation) {
  if (!std::ifstream("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
  const auto status = write_text_file("/dev/full", "x");
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().str(),
            "/dev/full: cannot be written to the end (No space left on device), expected space on the disk");
  EXPECT_EQ(status.error().exit_code, 1);
}

TEST(Gzip, FilesAreUnpackedWhateverTheirName) {
  const TemporaryFolder folder;
  const std::string file = folder.file("brdc.nav");
  for (const std::string& text : {std::string(), std::string("hello"), long_text()}) {
    ASSERT_TRUE(write_text_file(file, gzip(text)).ok());
    const auto back = read_text_or_gzip_file(file);
    ASSERT_TRUE(back.ok()) << back.error().str();
    EXPECT_EQ(*back, text);
  }
}

TEST(Gzip, MembersOneAfterAnotherAreOneText) {
  const TemporaryFolder folder;
  const std::string file = folder.file("two.gz");
  ASSERT_TRUE(write_text_file(file, gzip("one ") + gzip("two")).ok());
  EXPECT_EQ(*read_text_or_gzip_file(file), "one two");
}

TEST(Gzip, DamagedFilesAreErrors) {
  const TemporaryFolder folder;
  const std::string file = folder.file("damaged.gz");
  const std::string packed = gzip(long_text());
  ASSERT_TRUE(write_text_file(file, std::string_view(packed).substr(0, packed.size() / 2)).ok());
  EXPECT_EQ(read_text_or_gzip_file(file).error().str(),
            file + ": gzip data ends too early, expected a complete gzip file");
  std::string flipped = packed;
  flipped[packed.size() - 6] = static_cast<char>(flipped[packed.size() - 6] ^ 1);  // in the checksum
  ASSERT_TRUE(write_text_file(file, flipped).ok());
  EXPECT_EQ(read_text_or_gzip_file(file).error().str(), file + ": gzip data is damaged, expected a complete gzip file");
  ASSERT_TRUE(write_text_file(file, "\x1f\x8b").ok());
  EXPECT_FALSE(read_text_or_gzip_file(file).ok());
}

// FIPS 180-2, appendix B, and the digest of nothing.
TEST(Sha256, PublishedDigests) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_hex(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

}  // namespace
}  // namespace canyon
