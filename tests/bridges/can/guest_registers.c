// Preloaded into the user-mode-linux program: lets its guests run on processors with large registers (AMX).
//
// User-mode-linux 6.1 keeps 2696 bytes of a guest's extended registers, enough for AVX-512. The host takes them back
// only whole, which with AMX is some 11,000 bytes; so here the rest is filled in with what is there already.
// Layout: Intel SDM volume 1, section 13.4: the bits that say which components are set stand at byte 512.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <elf.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/types.h>
#include <sys/uio.h>

typedef long (*Ptrace)(enum __ptrace_request, ...);

static const size_t kComponents = 512;
static const uint64_t kKept = 0x3FF;  // components that fit into 2696 bytes: x87 to PKRU

long ptrace(enum __ptrace_request request, ...) {
  static Ptrace real;
  if (!real) real = (Ptrace)dlsym(RTLD_NEXT, "ptrace");
  va_list arguments;
  va_start(arguments, request);
  const pid_t pid = va_arg(arguments, pid_t);
  void* address = va_arg(arguments, void*);
  void* data = va_arg(arguments, void*);
  va_end(arguments);
  if (request != PTRACE_SETREGSET || (uintptr_t)address != NT_X86_XSTATE) return real(request, pid, address, data);

  static _Alignas(64) unsigned char whole[1 << 16];
  const struct iovec* given = (const struct iovec*)data;
  struct iovec all = {whole, sizeof whole};
  if (real(PTRACE_GETREGSET, pid, address, &all) != 0 || all.iov_len <= given->iov_len) {
    return real(request, pid, address, data);
  }
  uint64_t before, after;
  memcpy(&before, whole + kComponents, sizeof before);
  memcpy(whole, given->iov_base, given->iov_len);
  memcpy(&after, whole + kComponents, sizeof after);
  after = (after & kKept) | (before & ~kKept);
  memcpy(whole + kComponents, &after, sizeof after);
  return real(request, pid, address, &all);
}
