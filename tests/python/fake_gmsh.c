/* A library that looks like a libgmsh of version VERSION and can do nothing else. */

#include <stdlib.h>
#include <string.h>

void gmshOptionGetString(const char* name, char** value, int* ierr) {
  (void)name;
#ifdef NOT_INITIALIZED
  *value = NULL;
  *ierr = 1;
#else
  *value = malloc(strlen(VERSION) + 1);
  strcpy(*value, VERSION);
  *ierr = 0;
#endif
}

void gmshFree(void* memory) { free(memory); }

void gmshLoggerGetLastError(char** message, int* ierr) {
  *message = malloc(1);
  **message = '\0';
  *ierr = 0;
}
