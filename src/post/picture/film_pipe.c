/* SPDX-License-Identifier: BSD-3-Clause */
#include "film_pipe.h"
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

/* Not inherited by other children of the application, which would keep the pipe open. */
static bool keep_own(int file)
{
    return fcntl(file, F_SETFD, FD_CLOEXEC) == 0;
}

static int spawn(film_pipe *p, int input, const char *const *argv)
{
    posix_spawn_file_actions_t actions;
    int failed = posix_spawn_file_actions_init(&actions);
    if (failed) return failed;
    failed = posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    if (!failed)
        failed = posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY,
                                                  0);
    if (!failed)
        failed = posix_spawn_file_actions_adddup2(&actions, fileno(p->words), STDERR_FILENO);
    /* execvp() changes none of the texts, though its type allows it */
    if (!failed)
        failed = posix_spawnp(&p->child, argv[0], &actions, NULL, (char *const *)argv, environ);
    posix_spawn_file_actions_destroy(&actions);
    return failed;
}

/* A socket, not a pipe: after the end of the child a write to a pipe sends SIGPIPE to the whole
 * program; a write to a socket only fails. */
mps_status mps__pipe_start(film_pipe *p, const char *const *argv, page_errors *e)
{
    int both[2] = {-1, -1}, failed = 0;
    *p = (film_pipe){.program = argv[0], .end = -1, .words = tmpfile()};
    if (!p->words || socketpair(AF_UNIX, SOCK_STREAM, 0, both) != 0 || !keep_own(both[0]) ||
        !keep_own(both[1]) || !keep_own(fileno(p->words)))
        failed = errno;
    if (!failed) failed = spawn(p, both[1], argv);
    if (both[1] >= 0) close(both[1]);
    p->end = both[0];
    if (!failed) return MPS_OK;
    if (p->end >= 0) close(p->end);
    if (p->words) fclose(p->words);
    return mps__page_fail(e, failed == ENOMEM ? MPS_E_NOMEM : MPS_E_IO,
                          "cannot start the program '%s': %s%s", argv[0], strerror(failed),
                          failed == ENOENT ? "; films need ffmpeg, please install it" : "");
}

bool mps__pipe_write(film_pipe *p, const void *data, size_t size)
{
    const char *next = data;
    while (size > 0) {
        const ssize_t sent = send(p->end, next, size, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) return false;
        next += sent;
        size -= (size_t)sent;
    }
    return true;
}

/* The end of the child's stderr, in one line. */
static void last_words(film_pipe *p, char *out, size_t size)
{
    rewind(p->words);
    size_t length = fread(out, 1, size - 1, p->words);
    while (length > 0 && out[length - 1] == '\n') length--;
    out[length] = '\0';
    for (char *at = out; *at; at++)
        if ((unsigned char)*at < 0x20) *at = ' ';
}

mps_status mps__pipe_end(film_pipe *p, page_errors *e)
{
    char words[300];
    int ended = 0;
    pid_t child;
    close(p->end);
    do child = waitpid(p->child, &ended, 0);
    while (child < 0 && errno == EINTR);
    last_words(p, words, sizeof words);
    fclose(p->words);
    if (child == p->child && WIFEXITED(ended) && WEXITSTATUS(ended) == 0) return MPS_OK;
    if (words[0]) return mps__page_fail(e, MPS_E_IO, "'%s' failed: %s", p->program, words);
    if (child == p->child && WIFSIGNALED(ended))
        return mps__page_fail(e, MPS_E_IO, "'%s' was ended by signal %d", p->program,
                              WTERMSIG(ended));
    return mps__page_fail(e, MPS_E_IO, "'%s' failed with exit code %d", p->program,
                          child == p->child ? WEXITSTATUS(ended) : -1);
}
