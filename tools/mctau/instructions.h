/* Counts the instructions of this thread by the processor's own counter, where the kernel lets. */
#ifndef MCTAU_TOOLS_INSTRUCTIONS_H
#define MCTAU_TOOLS_INSTRUCTIONS_H

#include <stdint.h>

/* Opens the counter; gives a handle, negative where there is none. */
int instructions_open(void);
void instructions_begin(int handle);
/* Instructions since the beginning; 0 when they could not be counted. */
uint64_t instructions_end(int handle);
void instructions_close(int handle);

#endif
