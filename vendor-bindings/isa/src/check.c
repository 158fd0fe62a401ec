/* Ends the program with a sentence where the processor lacks an instruction set that Rust's code was compiled for. C,
   because it is compiled for every x86-64, whatever Rust's code is compiled for, and runs before it. */

#include <string.h>
#include <unistd.h>

static const char *lacking(void) {
    __builtin_cpu_init();
#define NEEDS(set)                                                                                                     \
    if (!__builtin_cpu_supports(set)) return set;
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
