// Texts, addresses and names that a viewer may send, fed with anything.
//
// The promises: no crash, no undefined behaviour; what is taken for a command has a name and is not nested deeply; a
// token and a host are accepted only when they are the right ones.
#include "window/wire/viewer_text.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "window/doorway.hpp"

namespace {

using namespace tandem;

void expect(bool condition) {
  if (!condition) std::abort();
}

int depth_of(const hal::Json& json) {
  int most = 0;
  if (json.is_array() || json.is_object()) {
    for (const hal::Json& item : json) most = std::max(most, depth_of(item));
    ++most;
  }
  return most;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto command = window::read_viewer_text(text); command.ok()) {
    expect(command.value().whole.is_object() && command.value().whole["do"] == command.value().name);
    expect(!command.value().whole.contains("id"));
    expect(depth_of(command.value().whole) <= window::kMostTextDepth);
    (void)hal::to_text(command.value().whole);
    (void)window::text_list(command.value().whole, "robots");
  }
  const std::string value = window::query_value(text, "token");
  expect(value.size() <= text.size());
  const window::Doorway doorway{"machine", {"http://other:80"}};
  if (doorway.host_is_ours(text)) expect(!text.empty());
  if (doorway.origin_is_ours(text, "machine:1"))
    expect(text.empty() || text.size() == std::string_view("http://machine:1").size() ||
           text.size() == std::string_view("http://other:80").size());
  return 0;
}
