#include "bridges/aseba/message.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <string>
#include <vector>

namespace tandem::bridges::aseba {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes encoded(const Message& message) {
  Payload payload;
  EXPECT_TRUE(encode(message, payload));
  return {payload.bytes().begin(), payload.bytes().end()};
}

template <class M>
M decoded(std::uint16_t type, const Bytes& payload) {
  static Bytes kept;  // texts and words lie in it
  kept = payload;
  Message message;
  EXPECT_EQ(decode(type, kept, message), Decoded::Good);
  EXPECT_TRUE(std::holds_alternative<M>(message));
  EXPECT_EQ(encoded(message), payload);
  EXPECT_EQ(type_of(message), type);
  return std::holds_alternative<M>(message) ? std::get<M>(message) : M{};
}

// The bytes that asebaplayground 1.6.99 and a host exchanged; recorded payloads.
TEST(Message, ReadsARecordedDescription) {
  const auto d = decoded<Description>(0x9000, {0x07, 0x65, 0x2D, 0x70, 0x75, 0x63, 0x6B, 0x30, 0x05, 0x00, 0x00,
                                               0x04, 0x20, 0x00, 0xE5, 0x01, 0x0E, 0x00, 0x02, 0x00, 0x21, 0x00});
  EXPECT_EQ(d.name, "e-puck0");
  EXPECT_EQ(d.version, 5);
  EXPECT_EQ(d.bytecode_words, 0x400);
  EXPECT_EQ(d.stack_words, 0x20);
  EXPECT_EQ(d.variable_words, 0x1E5);
  EXPECT_EQ(d.named_variables, 14);
  EXPECT_EQ(d.local_events, 2);
  EXPECT_EQ(d.native_functions, 33);
}

TEST(Message, ReadsRecordedVariablesAndEvents) {
  const auto source = decoded<NamedVariable>(0x9001, {0x01, 0x00, 0x06, 0x73, 0x6F, 0x75, 0x72, 0x63, 0x65});
  EXPECT_EQ(source.name, "source");
  EXPECT_EQ(source.words, 1);
  const auto args = decoded<NamedVariable>(0x9001, {0x20, 0x00, 0x04, 0x61, 0x72, 0x67, 0x73});
  EXPECT_EQ(args.words, 32);
  const auto event = decoded<LocalEvent>(
      0x9002, {0x0A, 0x69, 0x72, 0x5F, 0x73, 0x65, 0x6E, 0x73, 0x6F, 0x72, 0x73, 0x12, 0x49, 0x52, 0x20,
               0x73, 0x65, 0x6E, 0x73, 0x6F, 0x72, 0x73, 0x20, 0x75, 0x70, 0x64, 0x61, 0x74, 0x65, 0x64});
  EXPECT_EQ(event.name, "ir_sensors");
  EXPECT_EQ(event.meaning, "IR sensors updated");
}

TEST(Message, ReadsRecordedValues) {
  const auto values = decoded<Variables>(0x9005, {0x22, 0x00, 0x02, 0x00, 0xD4, 0xFE, 0x4D, 0x00, 0x00, 0x00});
  EXPECT_EQ(values.start, 34);
  ASSERT_EQ(values.words.size(), 4U);
  EXPECT_EQ(values.words[0], 2);
  EXPECT_EQ(values.words[1], -300);
  EXPECT_EQ(values.words[2], 77);
  EXPECT_EQ(values.words[3], 0);
  const auto state = decoded<ExecutionState>(0x900A, {0, 0, 0, 0});
  EXPECT_EQ(state.flags, 0);
  const auto result = decoded<BreakpointResult>(0x900B, {0, 0, 1, 0});
  EXPECT_EQ(result.success, 1);
  EXPECT_EQ(decoded<NodePresent>(0x900C, {5, 0}).number, 5);
}

TEST(Message, WritesTheRecordedRequests) {
  EXPECT_EQ(encoded(ListNodes{5}), (Bytes{0x05, 0x00}));
  EXPECT_EQ(encoded(GetDescription{4}), (Bytes{0x04, 0x00}));
  EXPECT_EQ(encoded(GetNodeDescription{1, 5}), (Bytes{0x01, 0x00, 0x05, 0x00}));
  EXPECT_EQ(encoded(GetVariables{1, 34, 4}), (Bytes{0x01, 0x00, 0x22, 0x00, 0x04, 0x00}));
  const Bytes values = {0xD4, 0xFE, 0x4D, 0x00};
  EXPECT_EQ(encoded(SetVariables{1, 35, Words(values)}), (Bytes{0x01, 0x00, 0x23, 0x00, 0xD4, 0xFE, 0x4D, 0x00}));
  EXPECT_EQ(encoded(GetExecutionState{1}), (Bytes{0x01, 0x00}));
  EXPECT_EQ(encoded(BreakpointSet{1, 0}), (Bytes{0x01, 0x00, 0x00, 0x00}));
  const Bytes arguments = {1, 0, 2, 0, 3, 0};
  EXPECT_EQ(encoded(UserEvent{5, Words(arguments)}), arguments);
}

TEST(Message, HasTheNumbersOfTheProtocol) {
  const std::vector<std::pair<Message, std::uint16_t>> numbers = {{BootloaderReset{}, 0x8000},
                                                                  {BootloaderReadPage{}, 0x8001},
                                                                  {BootloaderWritePage{}, 0x8002},
                                                                  {BootloaderPageDataWrite{}, 0x8003},
                                                                  {BootloaderDescription{}, 0x8004},
                                                                  {BootloaderPageDataRead{}, 0x8005},
                                                                  {BootloaderAck{}, 0x8006},
                                                                  {Description{}, 0x9000},
                                                                  {NamedVariable{}, 0x9001},
                                                                  {LocalEvent{}, 0x9002},
                                                                  {NativeFunction{}, 0x9003},
                                                                  {Disconnected{}, 0x9004},
                                                                  {Variables{}, 0x9005},
                                                                  {OutOfBounds{}, 0x9006},
                                                                  {DivisionByZero{}, 0x9007},
                                                                  {ExecutionKilled{}, 0x9008},
                                                                  {NodeError{}, 0x9009},
                                                                  {ExecutionState{}, 0x900A},
                                                                  {BreakpointResult{}, 0x900B},
                                                                  {NodePresent{}, 0x900C},
                                                                  {GetDescription{}, 0xA000},
                                                                  {SetBytecode{}, 0xA001},
                                                                  {Reset{}, 0xA002},
                                                                  {aseba::Run{}, 0xA003},
                                                                  {Pause{}, 0xA004},
                                                                  {Step{}, 0xA005},
                                                                  {Stop{}, 0xA006},
                                                                  {GetExecutionState{}, 0xA007},
                                                                  {BreakpointSet{}, 0xA008},
                                                                  {BreakpointClear{}, 0xA009},
                                                                  {BreakpointClearAll{}, 0xA00A},
                                                                  {GetVariables{}, 0xA00B},
                                                                  {SetVariables{}, 0xA00C},
                                                                  {WriteBytecode{}, 0xA00D},
                                                                  {Reboot{}, 0xA00E},
                                                                  {SuspendToRam{}, 0xA00F},
                                                                  {GetNodeDescription{}, 0xA010},
                                                                  {ListNodes{}, 0xA011}};
  EXPECT_EQ(numbers.size() + 1, std::variant_size_v<Message>);  // and the user event
  for (const auto& [message, number] : numbers) EXPECT_EQ(type_of(message), number);
}

TEST(Message, RefusesWhatIsTooShortTooLongOrUnknown) {
  Message message;
  EXPECT_EQ(decode(0xA00B, Bytes{1, 0, 2, 0, 3}, message), Decoded::TooShort);
  EXPECT_EQ(decode(0xA00B, Bytes{1, 0, 2, 0, 3, 0, 4}, message), Decoded::TooLong);
  EXPECT_EQ(decode(0x9005, Bytes{1, 0, 2}, message), Decoded::TooLong);
  EXPECT_EQ(decode(0x9005, Bytes{}, message), Decoded::TooShort);
  EXPECT_EQ(decode(0x9001, Bytes{1, 0, 5, 'a', 'b'}, message), Decoded::TooShort);
  EXPECT_EQ(decode(0x0005, Bytes{1}, message), Decoded::TooLong);
  EXPECT_EQ(decode(0xFFFF, Bytes{}, message), Decoded::UnknownType);
  EXPECT_EQ(decode(0x900D, Bytes{}, message), Decoded::UnknownType);
  EXPECT_EQ(decode(0xA012, Bytes{}, message), Decoded::UnknownType);
  EXPECT_EQ(decode(0xB000, Bytes{}, message), Decoded::UnknownType);
  EXPECT_EQ(decode(0x9020, Bytes{}, message), Decoded::UnknownType);
  EXPECT_EQ(decode(5, Bytes(kMostPayload + 2), message), Decoded::TooLong);
}

TEST(Message, TakesNamesOf255BytesAndEmptyOnes) {
  const std::string longest(255, 'x');
  Bytes bytes = {1, 0, 255};
  bytes.insert(bytes.end(), longest.begin(), longest.end());
  EXPECT_EQ(decoded<NamedVariable>(0x9001, bytes).name, longest);
  EXPECT_EQ(decoded<NamedVariable>(0x9001, {1, 0, 0}).name, "");
  const std::string longer(256, 'x');
  Payload payload;
  EXPECT_FALSE(encode(NamedVariable{1, longer}, payload));
}

TEST(Message, ChecksTheParametersOfNativeFunctions) {
  const auto function = decoded<NativeFunction>(0x9003, {1, 'f', 0, 2, 0, 0xFF, 0xFF, 1, 'a', 3, 0, 1, 'b'});
  EXPECT_EQ(function.parameters, 2);
  Message message;
  EXPECT_EQ(decode(0x9003, Bytes{1, 'f', 0, 3, 0, 0xFF, 0xFF, 1, 'a', 3, 0, 1, 'b'}, message), Decoded::TooShort);
  EXPECT_EQ(decode(0x9003, Bytes{1, 'f', 0, 1, 0, 0xFF, 0xFF, 1, 'a', 3, 0, 1, 'b'}, message), Decoded::TooLong);
  EXPECT_EQ(decode(0x9003, Bytes{0, 0, 0xFF, 0xFF}, message), Decoded::TooShort);
  Payload payload;
  NativeFunction wrong = function;
  wrong.parameters = 1;
  const Bytes two = {0xFF, 0xFF, 1, 'a', 3, 0, 1, 'b'};
  wrong.parameter_bytes = two;
  EXPECT_FALSE(encode(wrong, payload));
}

TEST(Message, SendsAnAddressOnlyWithTheAckThatHasOne) {
  EXPECT_EQ(decoded<BootloaderAck>(0x8006, {2, 0, 0x34, 0x12}).address, 0x1234);
  EXPECT_EQ(decoded<BootloaderAck>(0x8006, {1, 0}).address, 0);
  Message message;
  EXPECT_EQ(decode(0x8006, Bytes{2, 0}, message), Decoded::TooShort);
}

TEST(Message, EncodesNothingThatIsLongerThanAMessage) {
  const Bytes most(kMostPayload, 1);
  Payload payload;
  EXPECT_TRUE(encode(UserEvent{1, Words(most)}, payload));
  EXPECT_FALSE(encode(Variables{0, Words(most)}, payload));
  EXPECT_TRUE(encode(Variables{0, Words(std::span(most).first(2 * kMostRead))}, payload));
  EXPECT_FALSE(encode(SetVariables{0, 0, Words(std::span(most).first(2 * kMostRead))}, payload));
  EXPECT_TRUE(encode(SetVariables{0, 0, Words(std::span(most).first(2 * kMostWrite))}, payload));
  EXPECT_FALSE(encode(UserEvent{0x8000, {}}, payload));
}

TEST(Message, DecodesAnythingOrSaysWhyNot) {
  EXPECT_TRUE(rc::check([](std::uint8_t row, std::uint8_t low, const Bytes& bytes) {
    const auto type = static_cast<std::uint16_t>((0x8000U + (row % 4U) * 0x1000U) | (low % 34U));
    Message message;
    if (decode(type, bytes, message) != Decoded::Good) return;
    Payload payload;
    RC_ASSERT(encode(message, payload));
    RC_ASSERT(std::ranges::equal(payload.bytes(), bytes));
    RC_ASSERT(type_of(message) == type);
  }));
}

}  // namespace
}  // namespace tandem::bridges::aseba
