/* SPDX-License-Identifier: BSD-3-Clause */
/* The shared library of a plug-in: kind of file, checksum, function. */
#include "plugin_file.h"
#include "regular.h"
#include <dlfcn.h>
#include <elf.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

bool mps__plugin_fail(plugin_why *why, mps_status status, const char *format, ...)
{
    va_list values;
    if (why->status != MPS_OK) return false;
    why->status = status;
    va_start(values, format);
    vsnprintf(why->text, sizeof why->text, format, values);
    va_end(values);
    return false;
}

/* ---- kind of the file ---- */

static const char *machine_name(int machine, char *number, size_t size)
{
    static const struct {
        int machine;
        const char *name;
    } all[] = {{EM_X86_64, "x86-64"}, {EM_386, "x86"},      {EM_AARCH64, "ARM 64"}, {EM_ARM, "ARM"},
               {EM_PPC64, "POWER"},   {EM_RISCV, "RISC-V"}, {EM_S390, "S/390"}};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        if (all[k].machine == machine) return all[k].name;
    snprintf(number, size, "machine %d of ELF", machine);
    return number;
}

/* Type, machine, class and byte order are at the same offsets in all ELF headers. */
typedef struct elf_kind {
    unsigned char ident[EI_NIDENT];
    uint16_t type, machine;
} elf_kind;

static bool read_kind(FILE *file, elf_kind *kind)
{
    return fread(kind, 1, sizeof *kind, file) == sizeof *kind &&
           memcmp(kind->ident, ELFMAG, SELFMAG) == 0;
}

/* The kind of this program; machine 0: not known. */
static elf_kind own_kind(void)
{
    elf_kind own = {.machine = 0};
    FILE *file = fopen("/proc/self/exe", "rb");
    if (file && !read_kind(file, &own)) own.machine = 0;
    if (file) fclose(file);
    return own;
}

static bool check_kind(FILE *file, plugin_why *why)
{
    const elf_kind own = own_kind();
    elf_kind is;
    char numbers[2][40];
    if (!read_kind(file, &is))
        return mps__plugin_fail(why, MPS_E_IO,
                                "it is no shared library; build one by 'cc -shared -fPIC'");
    if (own.machine != 0 &&
        (is.machine != own.machine || is.ident[EI_CLASS] != own.ident[EI_CLASS] ||
         is.ident[EI_DATA] != own.ident[EI_DATA]))
        return mps__plugin_fail(why, MPS_E_IO,
                                "it is built for %s, %d bits, and this program for %s, %d bits",
                                machine_name(is.machine, numbers[0], sizeof numbers[0]),
                                is.ident[EI_CLASS] == ELFCLASS64 ? 64 : 32,
                                machine_name(own.machine, numbers[1], sizeof numbers[1]),
                                own.ident[EI_CLASS] == ELFCLASS64 ? 64 : 32);
    if (is.type != ET_DYN)
        return mps__plugin_fail(why, MPS_E_IO,
                                "it is %s, no shared library; build one by 'cc -shared -fPIC'",
                                is.type == ET_REL    ? "an object file"
                                : is.type == ET_EXEC ? "a program"
                                                     : "another file");
    return true;
}

/* The dynamic loader maps all segments without checking the length of the file: a truncated file
 * ends the program by SIGBUS. */
static bool is_whole(FILE *file, uint64_t size)
{
    ElfW(Ehdr) head;
    ElfW(Phdr) part;
    rewind(file);
    if (fread(&head, sizeof head, 1, file) != 1 || head.e_phentsize != sizeof part) return false;
    if (head.e_phoff > size || fseek(file, (long)head.e_phoff, SEEK_SET) != 0) return false;
    for (int k = 0; k < head.e_phnum; k++)
        if (fread(&part, sizeof part, 1, file) != 1 || part.p_offset > size ||
            part.p_filesz > size - part.p_offset)
            return false;
    return true;
}

/* Determine kind and checksum. */
static bool look_at(mps_plugin_file *p, plugin_why *why)
{
    struct stat s;
    const char *kind;
    FILE *file = mps__regular_stream(p->path, O_RDONLY, &kind);
    if (!file && kind) return mps__plugin_fail(why, MPS_E_IO, "%s", kind);
    if (!file || fstat(fileno(file), &s) != 0) {
        mps__plugin_fail(why, MPS_E_IO, "it cannot be read: %s", strerror(errno));
        if (file) fclose(file);
        return false;
    }
    bool good = check_kind(file, why);
    if (good && !is_whole(file, (uint64_t)s.st_size))
        good = mps__plugin_fail(why, MPS_E_IO, "it is cut short or damaged");
    rewind(file);
    if (good && !mps__sha256(file, p->sha256))
        good = mps__plugin_fail(why, MPS_E_IO, "it cannot be read: %s", strerror(errno));
    fclose(file);
    return good;
}

/* ---- loading ---- */

/* A plug-in linked to a second copy of libmps would receive handles of the first one. */
static bool same_library(const mps_plugin_file *p, plugin_why *why)
{
    const char *(*version)(int *, int *, int *);
    void *symbol = dlsym(p->handle, "mps_version");
    if (!symbol) return true; /* it calls no function of libmps */
    memcpy(&version, &symbol, sizeof version);
    if (version(NULL, NULL, NULL) == mps_version(NULL, NULL, NULL)) return true;
    return mps__plugin_fail(why, MPS_E_VERSION,
                            "it would use another copy of libmps, version %s; this program has a "
                            "libmps of its own, version %s, and needs to be linked with the shared "
                            "library",
                            version(NULL, NULL, NULL), mps_version(NULL, NULL, NULL));
}

static bool open_library(mps_plugin_file *p, plugin_why *why)
{
    p->handle = dlopen(p->path, RTLD_NOW | RTLD_LOCAL);
    if (p->handle) return true;
    const char *text = dlerror();
    const bool ours = text && strstr(text, "undefined symbol: mps_");
    return mps__plugin_fail(why, MPS_E_IO, "it cannot be loaded: %s%s",
                            text ? text : "the system loads no libraries here",
                            ours ? "; link it with libmps: $(pkg-config --libs mps)" : "");
}

bool mps__plugin_load(mps_plugin_file *p, const char *path, plugin_why *why)
{
    if (!realpath(path, p->path))
        return mps__plugin_fail(why, MPS_E_IO, "it cannot be read: %s", strerror(errno));
    if (!look_at(p, why) || !open_library(p, why) || !same_library(p, why)) return false;
    void *symbol = dlsym(p->handle, "mps_plugin");
    /* ISO C has no cast from void * to a function pointer */
    memcpy(&p->begin, &symbol, sizeof p->begin);
    if (symbol) return true;
    return mps__plugin_fail(why, MPS_E_PLUGIN,
                            "it has no function mps_plugin(), which <mps/plugin.h> declares");
}
