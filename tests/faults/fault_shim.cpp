// SPDX-License-Identifier: MIT
// A library that is loaded before others (LD_PRELOAD) and counts calls to the system, or lets one
// of them fail. It counts from the begin of main to its end, so that loading the program is left
// alone.
//
//   RAYMOVAL_FAULT_COUNTS=FILE   4096 zero bytes, in which the calls of all processes are counted
//   RAYMOVAL_FAULT=CALL,DEPTH,K  the K-th call (from 1) of this kind fails in the processes of this
//                                depth: 0 is the first process, 1 are its child processes
//   RAYMOVAL_FAULT_PLACES=FILE   the number of each allocation of depth RAYMOVAL_FAULT_AT whose
//                                callers are new is written there, one 64-bit number each
//
// Files of the system (/proc, /usr ...), pipes and standard error are ignored: they are no data of
// the program, and the number of reads depends on the clock.
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <initializer_list>

#define EXPORTED extern "C" __attribute__((visibility("default")))

EXPORTED void* __libc_malloc(size_t size);
EXPORTED void* __libc_calloc(size_t count, size_t size);
EXPORTED void* __libc_realloc(void* block, size_t size);
EXPORTED void* __libc_memalign(size_t alignment, size_t size);

namespace {

enum Call {
  kOpen,
  kRead,
  kWrite,
  kSync,
  kRename,
  kStat,
  kMap,
  kFork,
  kMemory,
  kMakeFolder,
  kRemove,
  kThread,
  kCalls
};

struct Kind {
  const char* name;
  int reason;
};
constexpr Kind kKinds[kCalls] = {{"open", EIO},     {"read", EIO},    {"write", ENOSPC},
                                 {"fsync", EIO},    {"rename", EIO},  {"stat", EIO},
                                 {"mmap", ENOMEM},  {"fork", EAGAIN}, {"malloc", ENOMEM},
                                 {"mkdir", ENOSPC}, {"unlink", EIO},  {"thread", EAGAIN}};

constexpr int kDepths = 4;

/// What all processes share.
struct Shared {
  std::atomic<uint64_t> counts[kDepths][kCalls];
  std::atomic<uint64_t> faults;
};
static_assert(sizeof(Shared) <= 4096, "the file of the counts has this size");

Shared* shared = nullptr;
std::atomic<bool> armed{false};
thread_local bool inside = false;  ///< This thread is in the code below already.
int depth = 0;
int wanted_call = -1, wanted_depth = -1;
uint64_t wanted_count = 0;
int places = -1;  ///< File for the numbers of allocations, or -1.

/// Keeps what the code below calls itself from being counted.
class Inside {
 public:
  Inside() : before_(inside) { inside = true; }
  ~Inside() { inside = before_; }
  Inside(const Inside&) = delete;
  Inside& operator=(const Inside&) = delete;

 private:
  bool before_;
};

/// Whether the callers of this allocation were not seen yet.
bool has_new_callers() {
  constexpr size_t kPlaces = 1 << 20;
  static std::atomic<uint64_t> seen[kPlaces];
  void* frames[16];
  const int count = backtrace(frames, 16);
  uint64_t hash = 1469598103934665603ULL;
  for (int i = 0; i < count; ++i) {
    hash = (hash ^ reinterpret_cast<uint64_t>(frames[i])) * 1099511628211ULL;
    hash ^= hash >> 29;
  }
  hash |= 1;
  for (size_t i = hash % kPlaces; seen[i] != hash; i = (i + 1) % kPlaces) {
    uint64_t none = 0;
    if (seen[i].compare_exchange_strong(none, hash)) return true;
  }
  return false;
}

/// Counts a call. @return whether it is to fail; then errno has the reason
bool fails(Call call) {
  if (!armed || inside || shared == nullptr) return false;
  const uint64_t number = ++shared->counts[depth][call];
  if (call == kMemory && places >= 0) {
    const Inside guard;
    if (has_new_callers()) syscall(SYS_write, places, &number, sizeof number);
  }
  if (call != wanted_call || depth != wanted_depth || number != wanted_count) return false;
  ++shared->faults;
  errno = kKinds[call].reason;
  return true;
}

bool starts(const char* text, const char* begin) {
  return strncmp(text, begin, strlen(begin)) == 0;
}

/// Whether a path does not belong to the system.
bool is_ours(const char* path) {
  if (starts(path, "/dev/shm/")) return true;
  for (const char* foreign : {"/proc", "/sys", "/dev", "/usr", "/lib", "/lib64", "/etc", "/run"}) {
    const char end = starts(path, foreign) ? path[strlen(foreign)] : 'x';
    if (end == '/' || end == '\0') return false;
  }
  return path[0] != '\0';
}

/// Whether a file that is open is a file, none of the system's; also standard output.
bool is_ours(int file) {
  if (!armed || inside || file == STDERR_FILENO) return false;
  if (file == STDOUT_FILENO) return true;
  char link[32];
  char target[512];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const long size = syscall(SYS_readlinkat, AT_FDCWD, link, target, sizeof target - 1);
  if (size <= 0) return false;
  target[size] = '\0';
  return target[0] == '/' && is_ours(target);
}

bool fails_at(Call call, const char* path) {
  return armed && is_ours(path) && fails(call);
}
bool fails_at(Call call, int file) {
  const int before = errno;
  const bool ours = is_ours(file);
  errno = before;
  return ours && fails(call);
}

template <class Function>
Function* real(const char* name) {
  const Inside guard;
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

int (*real_main)(int, char**, char**) = nullptr;

void read_orders() {
  if (const char* above = getenv("RAYMOVAL_FAULT_DEPTH")) depth = (atoi(above) + 1) % kDepths;
  char text[16];
  snprintf(text, sizeof text, "%d", depth);
  setenv("RAYMOVAL_FAULT_DEPTH", text, 1);
  char call[16] = {};
  if (const char* order = getenv("RAYMOVAL_FAULT")) {
    unsigned long long count = 0;
    if (sscanf(order, "%15[a-z],%d,%llu", call, &wanted_depth, &count) == 3) wanted_count = count;
  }
  for (int i = 0; i < kCalls; ++i) {
    if (strcmp(call, kKinds[i].name) == 0) wanted_call = i;
  }
  if (const char* file = getenv("RAYMOVAL_FAULT_COUNTS")) {
    const int opened = static_cast<int>(syscall(SYS_openat, AT_FDCWD, file, O_RDWR | O_CLOEXEC));
    void* memory = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, opened, 0);
    if (memory != MAP_FAILED) shared = static_cast<Shared*>(memory);
    syscall(SYS_close, opened);
  }
  const char* file = getenv("RAYMOVAL_FAULT_PLACES");
  const char* at = getenv("RAYMOVAL_FAULT_AT");
  if (file != nullptr && at != nullptr && atoi(at) == depth) {
    places = static_cast<int>(
        syscall(SYS_openat, AT_FDCWD, file, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666));
    void* frame = nullptr;
    backtrace(&frame, 1);  // Loads its library.
  }
}

int counted_main(int argc, char** argv, char** environment) {
  read_orders();
  armed = true;
  const int code = real_main(argc, argv, environment);
  armed = false;
  return code;
}

}  // namespace

EXPORTED int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv,
                               void (*init)(), void (*fini)(), void (*loader_fini)(),
                               void* stack_end) {
  real_main = main;
  using Start =
      int(int (*)(int, char**, char**), int, char**, void (*)(), void (*)(), void (*)(), void*);
  return real<Start>("__libc_start_main")(counted_main, argc, argv, init, fini, loader_fini,
                                          stack_end);
}

// REAL(open)(path, ...): the function of this name behind this library.
#define REAL(name)                                              \
  ([]() -> decltype(&::name) {                                  \
    static const auto function = real<decltype(::name)>(#name); \
    return function;                                            \
  }())

// Memory.

EXPORTED void* malloc(size_t size) {
  return fails(kMemory) ? nullptr : __libc_malloc(size);
}
EXPORTED void* calloc(size_t count, size_t size) {
  return fails(kMemory) ? nullptr : __libc_calloc(count, size);
}
EXPORTED void* realloc(void* block, size_t size) {
  return fails(kMemory) ? nullptr : __libc_realloc(block, size);
}
EXPORTED void* memalign(size_t alignment, size_t size) {
  return fails(kMemory) ? nullptr : __libc_memalign(alignment, size);
}
EXPORTED void* aligned_alloc(size_t alignment, size_t size) {
  return memalign(alignment, size);
}
EXPORTED int posix_memalign(void** block, size_t alignment, size_t size) {
  const int before = errno;
  *block = memalign(alignment, size);
  errno = before;
  return *block == nullptr ? ENOMEM : 0;
}

EXPORTED void* mmap(void* at, size_t size, int rights, int flags, int file, off_t offset) {
  if (fails(kMap)) return MAP_FAILED;
  return reinterpret_cast<void*>(syscall(SYS_mmap, at, size, rights, flags, file, offset));
}
EXPORTED void* mmap64(void* at, size_t size, int rights, int flags, int file, off64_t offset) {
  return mmap(at, size, rights, flags, file, offset);
}

// Opening.

namespace {

mode_t mode_of(int flags, va_list arguments) {
  const bool makes = (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
  return makes ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

EXPORTED int openat(int folder, const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  if (fails_at(kOpen, path)) return -1;
  return static_cast<int>(syscall(SYS_openat, folder, path, flags, mode));
}
EXPORTED int openat64(int folder, const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return openat(folder, path, flags, mode);
}
EXPORTED int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return openat(AT_FDCWD, path, flags, mode);
}
EXPORTED int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return openat(AT_FDCWD, path, flags, mode);
}
EXPORTED FILE* fopen(const char* path, const char* mode) {
  return fails_at(kOpen, path) ? nullptr : REAL(fopen)(path, mode);
}
EXPORTED FILE* fopen64(const char* path, const char* mode) {
  return fails_at(kOpen, path) ? nullptr : REAL(fopen64)(path, mode);
}
EXPORTED DIR* opendir(const char* path) {
  return fails_at(kOpen, path) ? nullptr : REAL(opendir)(path);
}
EXPORTED int memfd_create(const char* name, unsigned flags) noexcept {
  return fails(kOpen) ? -1 : static_cast<int>(syscall(SYS_memfd_create, name, flags));
}

// Reading.

EXPORTED ssize_t read(int file, void* data, size_t size) {
  return fails_at(kRead, file) ? -1 : syscall(SYS_read, file, data, size);
}
EXPORTED ssize_t pread(int file, void* data, size_t size, off_t offset) {
  return fails_at(kRead, file) ? -1 : syscall(SYS_pread64, file, data, size, offset);
}
EXPORTED ssize_t pread64(int file, void* data, size_t size, off64_t offset) {
  return pread(file, data, size, offset);
}
EXPORTED size_t fread(void* data, size_t size, size_t count, FILE* file) {
  return fails_at(kRead, fileno(file)) ? 0 : REAL(fread)(data, size, count, file);
}
EXPORTED dirent* readdir(DIR* folder) {
  return fails_at(kRead, dirfd(folder)) ? nullptr : REAL(readdir)(folder);
}
EXPORTED dirent64* readdir64(DIR* folder) {
  return fails_at(kRead, dirfd(folder)) ? nullptr : REAL(readdir64)(folder);
}

// Writing.

EXPORTED ssize_t write(int file, const void* data, size_t size) {
  return fails_at(kWrite, file) ? -1 : syscall(SYS_write, file, data, size);
}
EXPORTED ssize_t pwrite(int file, const void* data, size_t size, off_t offset) {
  return fails_at(kWrite, file) ? -1 : syscall(SYS_pwrite64, file, data, size, offset);
}
EXPORTED ssize_t pwrite64(int file, const void* data, size_t size, off64_t offset) {
  return pwrite(file, data, size, offset);
}
EXPORTED ssize_t writev(int file, const iovec* pieces, int count) {
  return fails_at(kWrite, file) ? -1 : syscall(SYS_writev, file, pieces, count);
}
EXPORTED size_t fwrite(const void* data, size_t size, size_t count, FILE* file) {
  return fails_at(kWrite, fileno(file)) ? 0 : REAL(fwrite)(data, size, count, file);
}
EXPORTED int fflush(FILE* file) {
  if (file != nullptr && fails_at(kWrite, fileno(file))) return EOF;
  return REAL(fflush)(file);
}
EXPORTED int fsync(int file) {
  return fails_at(kSync, file) ? -1 : static_cast<int>(syscall(SYS_fsync, file));
}
EXPORTED int fdatasync(int file) {
  return fails_at(kSync, file) ? -1 : static_cast<int>(syscall(SYS_fdatasync, file));
}
EXPORTED int ftruncate(int file, off_t size) noexcept {
  return fails_at(kWrite, file) ? -1 : static_cast<int>(syscall(SYS_ftruncate, file, size));
}

// Names.

EXPORTED int rename(const char* from, const char* to) noexcept {
  return fails_at(kRename, to) ? -1 : static_cast<int>(syscall(SYS_rename, from, to));
}
EXPORTED int renameat2(int from_folder, const char* from, int to_folder, const char* to,
                       unsigned flags) noexcept {
  if (fails_at(kRename, to)) return -1;
  return static_cast<int>(syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
}
EXPORTED int link(const char* from, const char* to) noexcept {
  return fails_at(kRename, to) ? -1 : static_cast<int>(syscall(SYS_link, from, to));
}
EXPORTED int mkdir(const char* path, mode_t mode) noexcept {
  return fails_at(kMakeFolder, path) ? -1 : static_cast<int>(syscall(SYS_mkdir, path, mode));
}
EXPORTED int unlink(const char* path) noexcept {
  return fails_at(kRemove, path) ? -1 : static_cast<int>(syscall(SYS_unlink, path));
}
EXPORTED int unlinkat(int folder, const char* path, int flags) noexcept {
  return fails_at(kRemove, path) ? -1
                                 : static_cast<int>(syscall(SYS_unlinkat, folder, path, flags));
}
EXPORTED int rmdir(const char* path) noexcept {
  return fails_at(kRemove, path) ? -1 : static_cast<int>(syscall(SYS_rmdir, path));
}
EXPORTED int remove(const char* path) noexcept {
  return fails_at(kRemove, path) ? -1 : REAL(remove)(path);
}

// Looking.

EXPORTED int stat(const char* path, struct stat* status) noexcept {
  if (fails_at(kStat, path)) return -1;
  return static_cast<int>(syscall(SYS_newfstatat, AT_FDCWD, path, status, 0));
}
EXPORTED int lstat(const char* path, struct stat* status) noexcept {
  if (fails_at(kStat, path)) return -1;
  return static_cast<int>(syscall(SYS_newfstatat, AT_FDCWD, path, status, AT_SYMLINK_NOFOLLOW));
}
EXPORTED int fstat(int file, struct stat* status) noexcept {
  return fails_at(kStat, file) ? -1 : static_cast<int>(syscall(SYS_fstat, file, status));
}
EXPORTED int fstatat(int folder, const char* path, struct stat* status, int flags) noexcept {
  if (fails_at(kStat, path)) return -1;
  return static_cast<int>(syscall(SYS_newfstatat, folder, path, status, flags));
}
EXPORTED int stat64(const char* path, struct stat64* status) noexcept {
  return stat(path, reinterpret_cast<struct stat*>(status));
}
EXPORTED int lstat64(const char* path, struct stat64* status) noexcept {
  return lstat(path, reinterpret_cast<struct stat*>(status));
}
EXPORTED int fstat64(int file, struct stat64* status) noexcept {
  return fstat(file, reinterpret_cast<struct stat*>(status));
}
EXPORTED int fstatat64(int folder, const char* path, struct stat64* status, int flags) noexcept {
  return fstatat(folder, path, reinterpret_cast<struct stat*>(status), flags);
}

// Processes and threads.

EXPORTED pid_t fork() noexcept {
  return fails(kFork) ? -1 : REAL(fork)();
}
EXPORTED int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                            void* (*start)(void*), void* argument) noexcept {
  using Create = int(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto create = real<Create>("pthread_create");
  return fails(kThread) ? EAGAIN : create(thread, attributes, start, argument);
}
