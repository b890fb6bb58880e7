/*
 * Counts the instructions of this thread: by the processor's own counter, where the kernel lets; or by valgrind, in
 * which the program runs once more, does the same pieces of work in the same order, and ends.
 */
#ifndef MCTAU_TOOLS_INSTRUCTIONS_H
#define MCTAU_TOOLS_INSTRUCTIONS_H

#include <stddef.h>
#include <stdint.h>

/* Opens a counter; gives a handle, negative where there is none. Under valgrind there is one, which tells nobody. */
int instructions_open(void);
void instructions_begin(int handle);
/* Instructions since the beginning; 0 when they could not be counted. */
uint64_t instructions_end(int handle);
void instructions_close(int handle);

/*
 * Runs this program under valgrind with its own arguments and `note`, which instructions_note gives there; of `pieces`
 * pairs of begin and end, counts[i] is the i-th. NULL, or why nothing was counted.
 */
const char *instructions_by_valgrind(const char *note, uint64_t *counts, size_t pieces);

/* What the program that runs this one under valgrind has noted; NULL in any other. */
const char *instructions_note(void);

#endif
