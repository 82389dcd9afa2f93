/* What carries messages between the processes of a run: mpi_plugin.c fills the table, team.cpp calls it. */
#ifndef BOLTZMANN_TEAM_FUNCTIONS_H
#define BOLTZMANN_TEAM_FUNCTIONS_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Of the table: a plug-in of another version is refused. */
enum { boltzmann_team_version = 3 };

enum { boltzmann_team_sum, boltzmann_team_min, boltzmann_team_max };

/* Bytes for a rank, or from one. */
typedef struct BoltzmannMessage {
  int rank, receive;
  void* bytes;
  int count;
} BoltzmannMessage;

/* `of` is whose table it is. All ranks call the same begin_... in the same order; one is under way at a time, and its
   memory stays until done() has said so. */
typedef struct BoltzmannTeamFunctions {
  int version;
  /* Which library it is, in one line; also before join(). */
  char const* (*library)(void);
  /* The calling process becomes one of `size`. 0, or an error of the library. */
  int (*join)(void* of, int* rank, int* size);
  /* Each number becomes the sum, minimum or maximum of those of all ranks. */
  void (*begin_reduce)(void* of, int64_t* numbers, int count, int operation);
  /* What this rank has becomes what the rank `from` has. */
  void (*begin_broadcast)(void* of, void* bytes, int count, int from);
  /* `all` becomes what all ranks have, `count` bytes of each, in the order of ranks. */
  void (*begin_gather)(void* of, void const* mine, int count, void* all);
  /* Messages between pairs of ranks: each that one sends is received by the other, with as many bytes, in the order in
     which the pair's are listed. */
  void (*begin_exchange)(void* of, BoltzmannMessage const* messages, int count);
  /* The same without copies, where ranks see each other's memory; null elsewhere. Where this rank writes so many bytes
     for each; then the exchange begins; when it is done, where those of each rank for this one stand until the next
     begin_... */
  void (*write_at)(void* of, uint64_t const* sizes, void** at);
  void (*begin_written)(void* of);
  void (*read_at)(void* of, void const** at);
  /* Whether the one under way has come to its end on this rank; never waits. */
  int (*done)(void* of);
  /* The last call of a rank. */
  void (*leave)(void* of);
  /* Ends all ranks. Comes back only where ranks are no processes. */
  void (*abort)(void* of, int status);
} BoltzmannTeamFunctions;

/* What the plug-in has under this name. */
typedef BoltzmannTeamFunctions const* (*BoltzmannMpi)(void);

#ifdef __cplusplus
}
#endif

#endif
