/* The transport of messages between the processes of a run: mpi_plugin.c fills the table, team.cpp calls it. */
#ifndef BOLTZMANN_TEAM_FUNCTIONS_H
#define BOLTZMANN_TEAM_FUNCTIONS_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Version of the table: a plug-in of another version is refused. */
enum { boltzmann_team_version = 3 };

enum { boltzmann_team_sum, boltzmann_team_min, boltzmann_team_max };

/* Bytes to a rank, or from one. */
typedef struct BoltzmannMessage {
  int rank, receive;
  void* bytes;
  int count;
} BoltzmannMessage;

/* `of` is the object that the table belongs to. All ranks call the same begin_... in the same order. One operation is
   pending at a time; its memory must stay valid until done() returns true. */
typedef struct BoltzmannTeamFunctions {
  int version;
  /* Names the library in one line; allowed before join(). */
  char const* (*library)(void);
  /* Makes the calling process one of `size` ranks. Returns 0, or an error of the library. */
  int (*join)(void* of, int* rank, int* size);
  /* Replaces each number by its sum, minimum or maximum over all ranks. */
  void (*begin_reduce)(void* of, int64_t* numbers, int count, int operation);
  /* Replaces the bytes by those of the rank `from`. */
  void (*begin_broadcast)(void* of, void* bytes, int count, int from);
  /* Fills `all` with `count` bytes of each rank, in the order of ranks. */
  void (*begin_gather)(void* of, void const* mine, int count, void* all);
  /* Exchanges messages between pairs of ranks. Each sent message is received by the other rank, with the same size, in
     the order in which the messages of the pair are listed. */
  void (*begin_exchange)(void* of, BoltzmannMessage const* messages, int count);
  /* An exchange without copies, if ranks see each other's memory; otherwise null. write_at() gives the addresses to
     which this rank writes `sizes` bytes for each rank; begin_written() starts the exchange. When it is done, read_at()
     gives the addresses of the bytes from each rank, which are valid until the next begin_... */
  void (*write_at)(void* of, uint64_t const* sizes, void** at);
  void (*begin_written)(void* of);
  void (*read_at)(void* of, void const** at);
  /* True if the pending operation is complete on this rank; never waits. */
  int (*done)(void* of);
  /* The last call of a rank. */
  void (*leave)(void* of);
  /* Ends all ranks. Returns only if ranks are not processes. */
  void (*abort)(void* of, int status);
} BoltzmannTeamFunctions;

/* The type of the function that the plug-in exports under this name. */
typedef BoltzmannTeamFunctions const* (*BoltzmannMpi)(void);

#ifdef __cplusplus
}
#endif

#endif
