// LD_PRELOAD: fails, or kills the program, at the N-th call of a kind, as a full disk, a lost
// drive, an exhausted memory or a power switch would.
//   INJECT_CALL   write, sync, rename, unlink (and rmdir), malloc, or end: when the program has done
//                 its work
//   INJECT_AT     which one, from 1
//   INJECT_KILL   set: SIGKILL ahead of the call, instead of an error
//   INJECT_LOSE   a folder: ahead of that SIGKILL every file in it that changed since the start, and
//                 was not synced since, becomes empty, as after a power failure; names stay
//   INJECT_ZEROS  set: such a file becomes zeros of its length instead
//   INJECT_MARK   this file is made when it happens
//   INJECT_ONLY   renames and removals of paths that begin otherwise do not count
//   INJECT_COUNT  a program that comes to its end writes to this file how many calls there were
// INJECT_DRIVE, set: every file lies on a drive without fsync, flock, symbolic links and exchange of
// names.
// Allocations count only when the program itself makes them, not a library for its own use.
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <link.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *old, size_t size);

enum kind { KIND_NONE, KIND_WRITE, KIND_SYNC, KIND_RENAME, KIND_UNLINK, KIND_MALLOC, KIND_END };

// A preloaded library has no owner to keep its state.
static enum kind wanted;
static long at;
static bool kills, plain_drive;
static const char *mark, *lose, *counts, *only;
static bool zeros;
static uintptr_t program_from, program_to;
static atomic_long count;

// --- a power failure ---

// What the drive is known to hold: the file as it was at the start, or when it was last synced.
struct held {
    dev_t device;
    ino_t file;
    off_t size;
    struct timespec changed;
};

enum { HELD_MAX = 1 << 16 };
static struct held held[HELD_MAX];
static size_t held_count;
static atomic_flag held_busy = ATOMIC_FLAG_INIT;

static bool is_held(const struct stat *st)
{
    for (size_t i = held_count; i-- > 0;)
        if (held[i].device == st->st_dev && held[i].file == st->st_ino)
            return held[i].size == st->st_size && held[i].changed.tv_sec == st->st_mtim.tv_sec &&
                   held[i].changed.tv_nsec == st->st_mtim.tv_nsec;
    return false;
}

static int hold(const char *path, const struct stat *st, int type, struct FTW *level)
{
    (void)path;
    (void)level;
    if (type != FTW_F || is_held(st))
        return 0;
    if (held_count == HELD_MAX)
        abort();
    held[held_count++] = (struct held){st->st_dev, st->st_ino, st->st_size, st->st_mtim};
    return 0;
}

static void hold_file(int fd)
{
    struct stat st;
    if (!lose || fstat(fd, &st) != 0 || !S_ISREG(st.st_mode))
        return;
    while (atomic_flag_test_and_set(&held_busy))
        ;
    hold(NULL, &st, FTW_F, NULL);
    atomic_flag_clear(&held_busy);
}

static int lose_file(const char *path, const struct stat *st, int type, struct FTW *level)
{
    (void)level;
    if (type != FTW_F || is_held(st))
        return 0;
    bool ok = truncate(path, 0) == 0 && (!zeros || truncate(path, st->st_size) == 0);
    return ok || errno == ENOENT ? 0 : -1;
}

static void walk(int (*visit)(const char *, const struct stat *, int, struct FTW *))
{
    if (lose && nftw(lose, visit, 16, FTW_PHYS) != 0)
        abort();
}

// --- which call ---

static int find_program(struct dl_phdr_info *info, size_t size, void *priv)
{
    (void)size;
    (void)priv;
    for (int i = 0; i < info->dlpi_phnum; i++) {
        const ElfW(Phdr) *header = &info->dlpi_phdr[i];
        if (header->p_type != PT_LOAD || !(header->p_flags & PF_X))
            continue;
        program_from = info->dlpi_addr + header->p_vaddr;
        program_to = program_from + header->p_memsz;
    }
    return 1; // the first is the program
}

__attribute__((constructor)) static void start(void)
{
    static const char *const names[] = {[KIND_WRITE] = "write", [KIND_SYNC] = "sync",
                                        [KIND_RENAME] = "rename", [KIND_UNLINK] = "unlink",
                                        [KIND_MALLOC] = "malloc", [KIND_END] = "end"};
    const char *call = getenv("INJECT_CALL"), *number = getenv("INJECT_AT");
    mark = getenv("INJECT_MARK");
    kills = getenv("INJECT_KILL") != NULL;
    plain_drive = getenv("INJECT_DRIVE") != NULL;
    lose = getenv("INJECT_LOSE");
    counts = getenv("INJECT_COUNT");
    only = getenv("INJECT_ONLY");
    zeros = getenv("INJECT_ZEROS") != NULL;
    at = number ? strtol(number, NULL, 10) : 0;
    dl_iterate_phdr(find_program, NULL);
    for (size_t i = 1; call && i < sizeof names / sizeof *names; i++)
        if (strcmp(call, names[i]) == 0)
            wanted = (enum kind)i;
    walk(hold);
    unsetenv("LD_PRELOAD"); // not for programs that this one runs
}

static bool hits(enum kind kind)
{
    if (kind != wanted || atomic_fetch_add(&count, 1) + 1 != at)
        return false;
    if (mark) {
        long fd = syscall(SYS_openat, AT_FDCWD, mark, O_CREAT | O_WRONLY, 0666);
        if (fd >= 0)
            syscall(SYS_close, fd);
    }
    if (kills) {
        walk(lose_file);
        syscall(SYS_kill, getpid(), SIGKILL);
    }
    return true;
}

static bool hits_path(enum kind kind, const char *path)
{
    return (!only || strncmp(path, only, strlen(only)) == 0) && hits(kind);
}

__attribute__((destructor)) static void end(void)
{
    (void)hits(KIND_END);
    FILE *file = counts ? fopen(counts, "w") : NULL;
    if (file) {
        wanted = KIND_NONE;
        fprintf(file, "%ld\n", atomic_load(&count));
        fclose(file);
    }
}

static void *next(const char *name)
{
    return dlsym(RTLD_NEXT, name);
}

// --- writing: a full disk ---

ssize_t write(int fd, const void *data, size_t size)
{
    if (hits(KIND_WRITE)) {
        errno = ENOSPC;
        return -1;
    }
    return syscall(SYS_write, fd, data, size);
}

ssize_t pwrite(int fd, const void *data, size_t size, off_t offset)
{
    if (hits(KIND_WRITE)) {
        errno = ENOSPC;
        return -1;
    }
    return syscall(SYS_pwrite64, fd, data, size, offset);
}

ssize_t pwrite64(int fd, const void *data, size_t size, off_t offset)
{
    return pwrite(fd, data, size, offset);
}

// Standard streams write by themselves, out of reach: their buffer fails instead.
size_t fwrite(const void *data, size_t size, size_t items, FILE *stream)
{
    if (stream != stderr && hits(KIND_WRITE)) {
        stream->_flags |= _IO_ERR_SEEN; // as the real one does
        errno = ENOSPC;
        return 0;
    }
    size_t (*real)(const void *, size_t, size_t, FILE *) = next("fwrite");
    return real(data, size, items, stream);
}

int fclose(FILE *stream)
{
    bool fails = hits(KIND_WRITE);
    int (*real)(FILE *) = next("fclose");
    int result = real(stream);
    if (!fails)
        return result;
    errno = ENOSPC;
    return EOF;
}

int fflush(FILE *stream)
{
    if (stream != stderr && hits(KIND_WRITE)) {
        errno = ENOSPC;
        return EOF;
    }
    int (*real)(FILE *) = next("fflush");
    return real(stream);
}

// --- the rest ---

int fsync(int fd)
{
    if (hits(KIND_SYNC)) {
        errno = EIO;
        return -1;
    }
    if (plain_drive) {
        errno = EINVAL;
        return -1;
    }
    int result = (int)syscall(SYS_fsync, fd);
    if (result == 0)
        hold_file(fd);
    return result;
}

int fdatasync(int fd)
{
    return fsync(fd);
}

int flock(int fd, int operation)
{
    if (plain_drive) {
        errno = EOPNOTSUPP;
        return -1;
    }
    return (int)syscall(SYS_flock, fd, operation);
}

int symlink(const char *target, const char *path)
{
    if (plain_drive) {
        errno = EPERM;
        return -1;
    }
    return (int)syscall(SYS_symlinkat, target, AT_FDCWD, path);
}

int rename(const char *from, const char *to)
{
    if (hits_path(KIND_RENAME, to)) {
        errno = EIO;
        return -1;
    }
    return (int)syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0);
}

int renameat2(int from_dir, const char *from, int to_dir, const char *to, unsigned flags)
{
    if (hits_path(KIND_RENAME, to)) {
        errno = EIO;
        return -1;
    }
    if (plain_drive && flags) {
        errno = EINVAL;
        return -1;
    }
    return (int)syscall(SYS_renameat2, from_dir, from, to_dir, to, flags);
}

int unlink(const char *path)
{
    if (hits_path(KIND_UNLINK, path)) {
        errno = EIO;
        return -1;
    }
    return (int)syscall(SYS_unlinkat, AT_FDCWD, path, 0);
}

int rmdir(const char *path)
{
    if (hits_path(KIND_UNLINK, path)) {
        errno = EIO;
        return -1;
    }
    return (int)syscall(SYS_unlinkat, AT_FDCWD, path, AT_REMOVEDIR);
}

static bool no_memory(void *caller)
{
    uintptr_t from = (uintptr_t)caller;
    if (from < program_from || from >= program_to || !hits(KIND_MALLOC))
        return false;
    errno = ENOMEM;
    return true;
}

void *malloc(size_t size)
{
    return no_memory(__builtin_return_address(0)) ? NULL : __libc_malloc(size);
}

void *calloc(size_t items, size_t size)
{
    return no_memory(__builtin_return_address(0)) ? NULL : __libc_calloc(items, size);
}

void *realloc(void *old, size_t size)
{
    return no_memory(__builtin_return_address(0)) ? NULL : __libc_realloc(old, size);
}
