// Preloaded into a program, lets one of its calls fail: TANDEM_FAILING_CALL=KIND:N is the N-th of that kind after main
// began. Kinds: alloc (only of the program and the C++ library), thread, open, read, write (not to standard error).
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <link.h>
#include <pthread.h>
#include <unistd.h>

namespace {

enum class Kind { None, Alloc, Thread, Open, Read, Write };

Kind kind = Kind::None;
std::atomic<long> left{-1};  // calls until the one that fails
std::atomic<bool> begun{false};

struct Range {
  ElfW(Addr) first = 0, last = 0;
};
Range program, cxx_library;

int note_object(dl_phdr_info* info, std::size_t /*size*/, void* /*unused*/) {
  Range range{~ElfW(Addr){0}, 0};
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const auto& header = info->dlpi_phdr[i];
    if (header.p_type != PT_LOAD) continue;
    const ElfW(Addr) first = info->dlpi_addr + header.p_vaddr;
    if (first < range.first) range.first = first;
    if (first + header.p_memsz > range.last) range.last = first + header.p_memsz;
  }
  if (info->dlpi_name == nullptr || info->dlpi_name[0] == '\0') program = range;
  if (info->dlpi_name != nullptr && std::strstr(info->dlpi_name, "libstdc++") != nullptr) cxx_library = range;
  return 0;
}

bool ours(const void* caller) {
  const auto at = reinterpret_cast<ElfW(Addr)>(caller);
  return (at >= program.first && at < program.last) || (at >= cxx_library.first && at < cxx_library.last);
}

bool fails(Kind called) {
  return called == kind && begun.load(std::memory_order_relaxed) && left.fetch_sub(1, std::memory_order_relaxed) == 1;
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

void begin() {
  const char* const text = std::getenv("TANDEM_FAILING_CALL");
  const char* const colon = text != nullptr ? std::strchr(text, ':') : nullptr;
  if (colon == nullptr) return;
  const struct {
    const char* name;
    Kind kind;
  } kinds[] = {{"alloc:", Kind::Alloc},
               {"thread:", Kind::Thread},
               {"open:", Kind::Open},
               {"read:", Kind::Read},
               {"write:", Kind::Write}};
  for (const auto& k : kinds) {
    if (std::strncmp(text, k.name, std::strlen(k.name)) == 0) kind = k.kind;
  }
  dl_iterate_phdr(&note_object, nullptr);
  left.store(std::atol(colon + 1));
  begun.store(true);
}

using Main = int (*)(int, char**, char**);
Main real_main = nullptr;

int main_when_begun(int argc, char** argv, char** env) {
  begin();
  return real_main(argc, argv, env);
}

}  // namespace

extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

int __libc_start_main(Main main, int argc, char** argv, void (*init)(), void (*fini)(), void (*rtld_fini)(),
                      void* end) {
  real_main = main;
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  return next<Start>("__libc_start_main")(&main_when_begun, argc, argv, init, fini, rtld_fini, end);
}

#define FAIL_ALLOC_IF_ASKED()                                    \
  if (ours(__builtin_return_address(0)) && fails(Kind::Alloc)) { \
    errno = ENOMEM;                                              \
    return nullptr;                                              \
  }

void* malloc(std::size_t size) {
  FAIL_ALLOC_IF_ASKED()
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  FAIL_ALLOC_IF_ASKED()
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  FAIL_ALLOC_IF_ASKED()
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  FAIL_ALLOC_IF_ASKED()
  return __libc_memalign(alignment, size);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*), void* argument) {
  if (fails(Kind::Thread)) return EAGAIN;
  return next<decltype(&pthread_create)>("pthread_create")(thread, attributes, start, argument);
}

#define OPEN(name)                                                         \
  int name(const char* path, int flags, ...) {                             \
    va_list list;                                                          \
    va_start(list, flags);                                                 \
    const mode_t mode = va_arg(list, mode_t);                              \
    va_end(list);                                                          \
    if (fails(Kind::Open)) {                                               \
      errno = EMFILE;                                                      \
      return -1;                                                           \
    }                                                                      \
    return next<int (*)(const char*, int, ...)>(#name)(path, flags, mode); \
  }
OPEN(open)
OPEN(open64)

#define FOPEN(name)                                                      \
  FILE* name(const char* path, const char* mode) {                       \
    if (fails(Kind::Open)) {                                             \
      errno = EMFILE;                                                    \
      return nullptr;                                                    \
    }                                                                    \
    return next<FILE* (*)(const char*, const char*)>(#name)(path, mode); \
  }
FOPEN(fopen)
FOPEN(fopen64)

ssize_t read(int descriptor, void* data, std::size_t size) {
  if (fails(Kind::Read)) {
    errno = EIO;
    return -1;
  }
  return next<decltype(&read)>("read")(descriptor, data, size);
}
std::size_t fread(void* data, std::size_t size, std::size_t count, FILE* file) {
  if (fails(Kind::Read)) {
    file->_flags |= 0x20;  // glibc's mark of an error
    errno = EIO;
    return 0;
  }
  return next<decltype(&fread)>("fread")(data, size, count, file);
}

ssize_t write(int descriptor, const void* data, std::size_t size) {
  if (descriptor != STDERR_FILENO && fails(Kind::Write)) {
    errno = ENOSPC;
    return -1;
  }
  return next<decltype(&write)>("write")(descriptor, data, size);
}
std::size_t fwrite(const void* data, std::size_t size, std::size_t count, FILE* file) {
  if (file != stderr && fails(Kind::Write)) {
    file->_flags |= 0x20;
    errno = ENOSPC;
    return 0;
  }
  return next<decltype(&fwrite)>("fwrite")(data, size, count, file);
}
}
