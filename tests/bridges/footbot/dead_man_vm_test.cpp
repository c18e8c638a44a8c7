// The dead-man program of a motors' module in ASEBA's own virtual machine, and beside ASEBA's own compiler: its
// variables tell whether the motor rests. The node is described and driven here by hand, from the protocol alone.
#include <array>
#include <cstdlib>
#include <filesystem>
#include <gmock/gmock.h>
#include <sstream>

// ASEBA's own headers.
#include <common/consts.h>
#include <common/msg/TargetDescription.h>
#include <compiler/compiler.h>
#include <vm/vm.h>

#include "bridges/aseba/dead_man.hpp"

extern "C" {
void AsebaSendMessage(AsebaVMState*, uint16_t, const void*, uint16_t) {}
void AsebaSendVariables(AsebaVMState*, uint16_t, uint16_t) {}
void AsebaSendDescription(AsebaVMState*) {}
void AsebaNativeFunction(AsebaVMState*, uint16_t) {}
void AsebaWriteBytecode(AsebaVMState*) {}
void AsebaResetIntoBootloader(AsebaVMState*) {}
void AsebaPutVmToSleep(AsebaVMState*) {}
void AsebaAssert(AsebaVMState*, int reason) {
  ADD_FAILURE() << "assertion " << reason;
}
}

namespace tandem::bridges::footbot {
namespace {

constexpr std::uint16_t kSpeed = 34, kMailbox = 37, kAlive = kMailbox + 3;
constexpr int kEvents = 25;  // of 20 ms: half a second

aseba::NodeDescription motor_module() {
  aseba::NodeDescription node;
  node.name = "left motor";
  node.bytecode_words = 1024;
  node.variable_words = 256;
  node.variables = {{"id", 0, 1}, {"source", 1, 1}, {"args", 2, 32}, {"speed", 34, 1}, {"odo", 35, 2}};
  node.local_events = {"button", "timer"};
  return node;
}

aseba::NodeProgram program() {
  return aseba::make_dead_man(motor_module(), "timer", {{kSpeed, 0}}).value();
}

/// A module whose program runs in ASEBA's own machine, told by the protocol's own messages.
class Module {
 public:
  Module() {
    vm_.nodeId = 1;
    vm_.bytecodeSize = static_cast<std::uint16_t>(bytecode_.size());
    vm_.bytecode = bytecode_.data();
    vm_.variablesSize = static_cast<std::uint16_t>(variables_.size());
    vm_.variables = variables_.data();
    vm_.stackSize = static_cast<std::uint16_t>(stack_.size());
    vm_.stack = stack_.data();
    AsebaVMInit(&vm_);
  }
  void load(const std::vector<std::uint16_t>& words) {
    std::vector<std::uint16_t> payload = {0};
    payload.insert(payload.end(), words.begin(), words.end());
    tell(ASEBA_MESSAGE_SET_BYTECODE, payload);
    tell(ASEBA_MESSAGE_RUN, {});
    AsebaVMRun(&vm_, 1000);
  }
  void set(std::uint16_t address, std::int16_t value) {
    tell(ASEBA_MESSAGE_SET_VARIABLES, {address, static_cast<std::uint16_t>(value)});
  }
  /// The node's second event of its own, `count` times.
  void timer(int count = 1) {
    for (int i = 0; i < count; ++i) {
      AsebaVMSetupEvent(&vm_, ASEBA_EVENT_LOCAL_EVENTS_START - 1);
      AsebaVMRun(&vm_, 1000);
    }
  }
  std::int16_t word(std::size_t address) const { return variables_[address]; }

 private:
  void tell(std::uint16_t type, std::vector<std::uint16_t> payload) {
    payload.insert(payload.begin(), 1);  // the node
    AsebaVMDebugMessage(&vm_, type, payload.data(), static_cast<std::uint16_t>(payload.size()));
  }
  AsebaVMState vm_{};
  std::array<std::uint16_t, 1024> bytecode_{};
  std::array<std::int16_t, 256> variables_{};
  std::array<std::int16_t, 32> stack_{};
};

TEST(DeadManInAsebasMachine, StopsTheMotorHalfASecondAfterTheLastWordOfItsHub) {
  Module module;
  module.load(program().words);
  module.timer(3);
  EXPECT_EQ(module.word(kMailbox + aseba::mail_head::kSignature), program().signature);
  EXPECT_EQ(module.word(kMailbox + aseba::mail_head::kBeat), 3);
  for (int second = 0; second < 3; ++second) {  // the hub drives, and says so in time
    module.set(kAlive, kEvents);
    module.set(kSpeed, 40);
    module.timer(kEvents - 1);
    EXPECT_EQ(module.word(kSpeed), 40);
  }
  EXPECT_EQ(module.word(kMailbox + aseba::mail_head::kLapses), 0);
  module.timer();  // and no more
  EXPECT_EQ(module.word(kSpeed), 0);
  EXPECT_EQ(module.word(kMailbox + aseba::mail_head::kLapses), 1);
}

TEST(DeadManInAsebasMachine, LeavesAloneWhoeverWritesWithoutAHub) {
  Module module;
  module.load(program().words);
  module.set(kSpeed, 40);
  module.timer(10 * kEvents);
  EXPECT_EQ(module.word(kSpeed), 40);
  module.set(kAlive, kEvents);
  module.set(kAlive, 0);  // a hub that came to rest
  module.timer(10 * kEvents);
  EXPECT_EQ(module.word(kSpeed), 40);
  EXPECT_EQ(module.word(kMailbox + aseba::mail_head::kLapses), 0);
}

/// The compiler asks for a locale of this name; any in UTF-8 serves, and the C library brings one.
class LocaleOfTheCompiler {
 public:
  LocaleOfTheCompiler() {
    std::string pattern = (std::filesystem::temp_directory_path() / "locale_XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
    std::filesystem::create_symlink("/usr/lib/locale/C.utf8", folder_ / "en_US.UTF-8");
    ::setenv("LOCPATH", folder_.c_str(), 1);
  }
  ~LocaleOfTheCompiler() {
    ::unsetenv("LOCPATH");
    std::filesystem::remove_all(folder_);
  }
  LocaleOfTheCompiler(const LocaleOfTheCompiler&) = delete;
  LocaleOfTheCompiler& operator=(const LocaleOfTheCompiler&) = delete;

 private:
  std::filesystem::path folder_;
};

TEST(DeadManInAsebasMachine, HasTheWordsOfAsebasOwnCompiler) {
  const LocaleOfTheCompiler locale;
  Aseba::TargetDescription target;
  target.name = L"left motor";
  target.protocolVersion = ASEBA_PROTOCOL_VERSION;
  target.bytecodeSize = 1024;
  target.variablesSize = 256;
  target.stackSize = 32;
  for (const aseba::Variable& v : motor_module().variables)
    target.namedVariables.emplace_back(std::wstring(v.name.begin(), v.name.end()), v.words);
  target.localEvents = {{L"button", L""}, {L"timer", L""}};
  const Aseba::CommonDefinitions common;
  Aseba::Compiler compiler;
  compiler.setTargetDescription(&target);
  compiler.setCommonDefinitions(&common);
  std::wistringstream source(L"var mail[4]\nonevent timer\nmail[1] = mail[1] + 1\nmail[0] = " +
                             std::to_wstring(program().signature) +
                             L"\nif mail[3] > 0 then\nmail[3] = mail[3] - 1\nif 1 > mail[3] then\nspeed = 0\n"
                             L"mail[2] = mail[2] + 1\nend\nend\n");
  Aseba::BytecodeVector bytecode;
  unsigned variables = 0;
  Aseba::Error error;
  ASSERT_TRUE(compiler.compile(source, bytecode, variables, error))
      << std::string(error.message.begin(), error.message.end());
  std::vector<std::uint16_t> words;
  for (const Aseba::BytecodeElement& element : bytecode) words.push_back(element.bytecode);
  EXPECT_EQ(program().words, words);
  Module module;  // theirs does what ours does
  module.load(words);
  module.set(kAlive, kEvents);
  module.set(kSpeed, -40);
  module.timer(kEvents);
  EXPECT_EQ(module.word(kSpeed), 0);
}

}  // namespace
}  // namespace tandem::bridges::footbot
