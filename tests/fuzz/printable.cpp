// Texts of strangers, fed with anything: what people get commands no terminal, hides and turns nothing, and forges no
// line of a log.
#include "hal/printable.hpp"

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

namespace {

using namespace tandem::hal;

void expect(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::string plain = printable(text);
  for (const char c : plain) expect(c == '\n' || c == '\t' || (static_cast<std::uint8_t>(c) >= 0x20 && c != 0x7F));
  for (const std::string_view turns : {"\u202A", "\u202E", "\u2066", "\u2069", "\u200F", "\u200B", "\u2028", "\uFEFF"})
    expect(plain.find(turns) == std::string::npos);
  expect(printable(plain) == plain);
  const std::string entry = printable_entry(text);
  for (std::size_t at = entry.find('\n'); at != std::string::npos; at = entry.find('\n', at + 1))
    expect(entry.compare(at + 1, 4, "    ") == 0);
  const std::size_t most = size / 2;
  const std::string cut = shortened(text, most);
  expect(cut.size() <= most + 64 && (text.size() > most || cut == text));
  return 0;
}
