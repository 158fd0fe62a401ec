/* Ends the program with a sentence where the processor lacks an instruction set that Rust's code was compiled for. C,
   because it is compiled for every x86-64, whatever Rust's code is compiled for, and runs before it. It asks the
   processor itself: the runtime libraries of some compilers answer `__builtin_cpu_supports` with no. */

#include <cpuid.h>
#include <string.h>
#include <unistd.h>

enum reg { EAX, EBX, ECX, EDX };

/* Registers that the operating system has to save: none beyond those of SSE, those of AVX, those of AVX-512. */
enum state { SSE = 0, AVX = 0x6, AVX512 = 0xe6 };

struct set {
    const char *name;
    unsigned leaf;
    enum reg reg;
    unsigned bit;
    unsigned state;
};

static const struct set sets[] = {
    {"sse2", 1, EDX, 26, SSE},
    {"sse3", 1, ECX, 0, SSE},
    {"ssse3", 1, ECX, 9, SSE},
    {"sse4.1", 1, ECX, 19, SSE},
    {"sse4.2", 1, ECX, 20, SSE},
    {"movbe", 1, ECX, 22, SSE},
    {"popcnt", 1, ECX, 23, SSE},
    {"avx", 1, ECX, 28, AVX},
    {"fma", 1, ECX, 12, AVX},
    {"f16c", 1, ECX, 29, AVX},
    {"bmi1", 7, EBX, 3, SSE},
    {"avx2", 7, EBX, 5, AVX},
    {"bmi2", 7, EBX, 8, SSE},
    {"lzcnt", 0x80000001, ECX, 5, SSE},
    {"xop", 0x80000001, ECX, 11, AVX},
    {"avx512f", 7, EBX, 16, AVX512},
    {"avx512dq", 7, EBX, 17, AVX512},
    {"avx512ifma", 7, EBX, 21, AVX512},
    {"avx512cd", 7, EBX, 28, AVX512},
    {"avx512bw", 7, EBX, 30, AVX512},
    {"avx512vl", 7, EBX, 31, AVX512},
    {"avx512vbmi", 7, ECX, 1, AVX512},
    {"avx512vbmi2", 7, ECX, 6, AVX512},
    {"gfni", 7, ECX, 8, SSE},
    {"avx512vnni", 7, ECX, 11, AVX512},
    {"avx512bitalg", 7, ECX, 12, AVX512},
    {"avx512vpopcntdq", 7, ECX, 14, AVX512},
};

/* Whether the processor has the bit of a leaf. */
static int has(unsigned leaf, enum reg reg, unsigned bit) {
    unsigned regs[4];
    return __get_cpuid_count(leaf, 0, &regs[EAX], &regs[EBX], &regs[ECX], &regs[EDX]) && (regs[reg] >> bit & 1);
}

/* Registers that the operating system saves. */
static unsigned saved(void) {
    unsigned low, high;
    if (!has(1, ECX, 27)) return 0;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return low;
}

/* Whether a set can be used. Sets that the table lacks cannot, so that a test notices. */
static int can_use(const char *name) {
    for (unsigned i = 0; i < sizeof sets / sizeof *sets; i++)
        if (!strcmp(sets[i].name, name))
            return has(sets[i].leaf, sets[i].reg, sets[i].bit) && (saved() & sets[i].state) == sets[i].state;
    return 0;
}

static const char *lacking(void) {
#define NEEDS(set)                                                                                                     \
    if (!can_use(set)) return set;
#include "needs.h"
    return 0;
}

static void say(const char *text) {
    ssize_t written = write(STDERR_FILENO, text, strlen(text));
    (void)written;
}

__attribute__((constructor(101))) static void check(void) {
    const char *set = lacking();
    if (!set) return;
    say("error: this processor lacks ");
    say(set);
    say(", for which the program was compiled; compile it on this machine, or with RUSTFLAGS= (empty) for every processor\n");
    _exit(1);
}

/* Called so that the linker takes this file, and the constructor in it. */
void isa_is_checked(void) {}
