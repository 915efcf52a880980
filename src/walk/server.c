// The server: one thread, which serves the network by libwebsockets' event loop and, between two
// rounds of the loop, draws one frame for the client that has waited longest.
#include "walk/server.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <libwebsockets.h>

#include "core/json.h"
#include "core/memory.h"
#include "walk/choices.h"
#include "walk/content_internal.h"
#include "walk/internal.h"
#include "walk/live.h"
#include "walk/rendering.h"

enum {
    MESSAGE_MAX = 65536, // bytes of a message at most, of clients that may change nothing
    RECEIVE = 4096,      // bytes of a message that are received at once
    CLIENTS_MAX = 64,
    CHUNK = 16384,       // bytes of a file that are written at once
    TOKEN_BYTES = 16,
    HEADERS = 2048,      // bytes of an answer's headers
    IDLE_S = 30,         // seconds until an unfinished request ends the connection
};

// A connection: a request for a file, or a client that walks.
struct session {
    struct lws *wsi;
    struct lws_dll2 link; // in the list of clients that walk
    // A client that walks: its newest request, and the frame that is being sent.
    struct walk_request request;
    struct orl_choice choice; // its method and options
    bool wants, sending;
    unsigned waits_since;
    uint8_t *frame; // owned, with LWS_PRE bytes of room before it; NULL: no frame to send
    size_t frame_size;
    struct orl_bytes message; // of a client, which arrives in parts
    json_t *reply;      // owned: an object to send; NULL: none
    bool asks_site;     // waits for the published site's data
    // A request for a file.
    struct content_file file;
    size_t written;
};

struct server {
    const struct orl_log *log;
    const struct orl_walk_params *params;
    struct walk_renderer walk;
    struct live *live;         // NULL: time steps are the scene's
    struct content content;
    struct lws_context *context;
    char policy[1024];         // where the page and what it shows may come from
    struct lws_protocol_vhost_options headers; // of every answer
    struct lws_dll2_owner sessions; // of clients that walk
    unsigned clock;
    char token[2 * TOKEN_BYTES + 1]; // "": no token is needed
    json_t *to_render;         // owned: what a client wants rendered, until it is; NULL: nothing
    struct orl_choice render_choice; // that client's method and options
    struct session *renders_for; // that client; NULL: it has gone
    enum orl_result result;    // the first failure
};

// --- access ---

static bool is_local(const char *name)
{
    return strcmp(name, "127.0.0.1") == 0 || strcasecmp(name, "localhost") == 0 ||
           strcasecmp(name, "localhost.") == 0 || strcmp(name, "[::1]") == 0 || strcmp(name, "::1") == 0;
}

// Without a token, a request must name this machine as its host. This stops another site's page
// whose host name resolves to this machine (DNS rebinding). Pages of another origin are always
// refused. A page that came through a proxy may be of https, where the server is not.
static bool asks_from_here(const struct server *server, struct lws *wsi)
{
    char host[256] = "", origin[300] = "";
    if (lws_hdr_copy(wsi, host, sizeof host, WSI_TOKEN_HOST) <= 0)
        return false;
    if (lws_hdr_total_length(wsi, WSI_TOKEN_ORIGIN) > 0) {
        const char *at = lws_hdr_copy(wsi, origin, sizeof origin, WSI_TOKEN_ORIGIN) > 0
                             ? strstr(origin, "://") : NULL;
        bool web = strncmp(origin, "http://", 7) == 0 || strncmp(origin, "https://", 8) == 0;
        if (!at || !web || strcasecmp(at + 3, host) != 0)
            return false;
    }
    char *port = strrchr(host, ':');
    if (port && !strchr(port, ']'))
        *port = '\0';
    return server->token[0] || is_local(host);
}

static bool has_token(const struct server *server, struct lws *wsi)
{
    char argument[128];
    size_t length = strlen(server->token);
    if (!length)
        return true;
    const char *given = lws_get_urlarg_by_name(wsi, "token=", argument, sizeof argument);
    // Constant time: the duration tells nothing about the token.
    return given && strlen(given) == length && lws_timingsafe_bcmp(given, server->token, (uint32_t)length) == 0;
}

// --- files ---

static int refuse(struct lws *wsi, unsigned status)
{
    return lws_return_http_status(wsi, status, NULL) != 0 || lws_http_transaction_completed(wsi) ? -1
                                                                                                  : 0;
}

static void forget_file(struct session *session)
{
    free(session->file.data);
    session->file = (struct content_file){0};
}

static int end_file(struct lws *wsi, struct session *session)
{
    forget_file(session);
    return lws_http_transaction_completed(wsi) ? -1 : 0;
}

static int start_file(struct server *server, struct lws *wsi, struct session *session,
                      const char *path)
{
    unsigned char buffer[LWS_PRE + HEADERS], *at = buffer + LWS_PRE, *end = buffer + sizeof buffer - 1;
    char *uri;
    int length, method = lws_http_get_uri_and_method(wsi, &uri, &length);
    if (!asks_from_here(server, wsi))
        return refuse(wsi, HTTP_STATUS_FORBIDDEN);
    if (method != LWSHUMETH_GET && method != LWSHUMETH_HEAD) {
        (void)!lws_return_http_status(wsi, HTTP_STATUS_METHOD_NOT_ALLOWED, NULL);
        return -1; // a body that came with the request is not read: the connection ends
    }
    // Before anything is made: without the token, nobody learns what there is, nor keeps the server busy.
    if (!orl_content_is_page(path) && !has_token(server, wsi))
        return refuse(wsi, HTTP_STATUS_FORBIDDEN);
    forget_file(session);
    enum orl_result result = orl_content_find(&server->content, path, &session->file);
    if (result != ORL_OK)
        return refuse(wsi, result == ORL_ERR_NOT_FOUND ? HTTP_STATUS_NOT_FOUND
                                                       : HTTP_STATUS_INTERNAL_SERVER_ERROR);
    session->written = 0;
    if (lws_add_http_common_headers(wsi, HTTP_STATUS_OK, session->file.type, session->file.size,
                                    &at, end) ||
        lws_finalize_write_http_header(wsi, buffer + LWS_PRE, &at, end))
        return -1;
    if (method == LWSHUMETH_HEAD)
        return end_file(wsi, session);
    lws_callback_on_writable(wsi);
    return 0;
}

static int continue_file(struct lws *wsi, struct session *session)
{
    unsigned char buffer[LWS_PRE + CHUNK];
    size_t left = session->file.size - session->written, size = left < CHUNK ? left : CHUNK;
    memcpy(buffer + LWS_PRE, session->file.data + session->written, size);
    session->written += size;
    bool last = session->written == session->file.size;
    if (lws_write(wsi, buffer + LWS_PRE, size, last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP) < 0)
        return -1;
    if (last)
        return end_file(wsi, session);
    lws_callback_on_writable(wsi);
    return 0;
}

// --- clients that walk ---

static struct session *session_of(struct lws_dll2 *link)
{
    return lws_container_of(link, struct session, link);
}

static void remove_session(struct server *server, struct session *session)
{
    lws_dll2_remove(&session->link);
    if (server->renders_for == session)
        server->renders_for = NULL;
    free(session->frame);
    free(session->message.data);
    json_decref(session->reply);
    *session = (struct session){0};
}

static int close_for(struct lws *wsi, enum lws_close_status status)
{
    lws_close_reason(wsi, status, NULL, 0);
    return -1;
}

// Sends a JSON object, which is released, as soon as the client takes it. Entries that have not
// been sent are replaced by newer ones of the same key, which say more.
static enum orl_result reply(struct session *session, json_t *object)
{
    session->reply = session->reply ? session->reply : json_object();
    bool added = object && session->reply && json_object_update(session->reply, object) == 0;
    json_decref(object);
    if (added)
        lws_callback_on_writable(session->wsi);
    return added ? ORL_OK : ORL_ERR_MEMORY;
}

static enum orl_result refuse_rendering(struct session *session, const char *problem)
{
    return reply(session, json_pack("{s:{s:i, s:i, s:s}}", "rendering", "done", 0, "total", 0,
                                    "problem", problem));
}

// One rendering at a time; serve() begins it.
static bool take_rendering(struct server *server, struct session *session, json_t *message)
{
    if (server->to_render)
        return refuse_rendering(session, "another one is under way") == ORL_OK;
    server->to_render = json_incref(message);
    server->render_choice = session->choice;
    server->renders_for = session;
    return true;
}

// What the session's frames are drawn by from now on. problem: why that is not what was asked for;
// "": it is.
static enum orl_result tell_choice(struct session *session, const char *problem)
{
    return reply(session, json_pack("{s:o, s:o}", "choice", orl_walk_choice_json(&session->choice),
                                    "problem", orl_json_string(problem)));
}

static bool take_choice(const struct server *server, struct session *session, const json_t *message)
{
    char problem[WALK_PROBLEM_BYTES];
    enum orl_result result = orl_walk_choice_read(server->content.scene, message, &session->choice,
                                                  problem);
    return tell_choice(session, result == ORL_OK ? "" : problem) == ORL_OK;
}

// --- the published site's data, for clients that draw by themselves ---

// Tells all who wait for the data their state, which is released, and that they need not wait any more
// if that is `last`.
static enum orl_result tell_site(const struct server *server, json_t *state, bool last)
{
    enum orl_result result = state ? ORL_OK : ORL_ERR_MEMORY;
    for (struct lws_dll2 *link = server->sessions.head; link && result == ORL_OK; link = link->next) {
        struct session *s = session_of(link);
        if (!s->asks_site)
            continue;
        result = reply(s, json_pack("{s:O}", "site", state));
        s->asks_site = !last;
    }
    json_decref(state);
    return result;
}

static enum orl_result tell_site_ready(const struct server *server)
{
    return tell_site(server, json_pack("{s:b}", "ready", 1), true);
}

static bool someone_asks_site(const struct server *server)
{
    struct lws_dll2 *link = server->sessions.head;
    while (link && !session_of(link)->asks_site)
        link = link->next;
    return link != NULL;
}

// serve() begins to make the data, unless they are there.
static bool take_site_request(const struct server *server, struct session *session)
{
    session->asks_site = true;
    return !server->content.site || tell_site_ready(server) == ORL_OK;
}

// --- messages ---

// A message about something else than a frame: {"save": settings}, {"render": path}, {"method":
// name, "set": options} or {"site": true}. Returns false for a message that is none of these.
static bool take_command(struct server *server, struct session *session, json_t *root)
{
    json_t *settings = json_object_get(root, "save");
    bool known = settings && server->content.edits;
    if (json_is_true(json_object_get(root, "site"))) {
        known = take_site_request(server, session);
    } else if (server->content.edits && orl_walk_rendering_asked(root)) {
        known = take_rendering(server, session, root);
    } else if (server->content.edits && orl_walk_choice_asked(root)) {
        known = take_choice(server, session, root);
    } else if (known) {
        enum orl_result result = orl_content_change(&server->content, settings);
        known = reply(session,
                      json_pack("{s:b, s:s}", "saved", result == ORL_OK, "reason",
                                result == ORL_OK ? "" : orl_result_message(result))) == ORL_OK;
    }
    return known;
}

// A newer request for a frame replaces an older one for which no frame has been drawn.
static int take_message(struct server *server, struct session *session, const char *data, size_t size)
{
    struct lws *wsi = session->wsi;
    if (lws_frame_is_binary(wsi))
        return close_for(wsi, LWS_CLOSE_STATUS_UNACCEPTABLE_OPCODE);
    size_t most = server->content.edits ? WALK_SETTINGS_MAX : MESSAGE_MAX;
    if (size > most - session->message.size)
        return close_for(wsi, LWS_CLOSE_STATUS_MESSAGE_TOO_LARGE);
    if (orl_bytes_add(server->log, &session->message, data, size) != ORL_OK)
        return -1;
    if (!lws_is_final_fragment(wsi) || lws_remaining_packet_payload(wsi) > 0)
        return 0;
    json_t *root = json_loadb(session->message.data, session->message.size, JSON_REJECT_DUPLICATES, NULL);
    struct walk_request request;
    bool asks = orl_walk_request_read(root, &request), valid = asks || take_command(server, session, root);
    json_decref(root);
    session->message.size = 0;
    if (!valid)
        return close_for(wsi, LWS_CLOSE_STATUS_INVALID_PAYLOAD);
    if (!asks)
        return 0;
    session->request = request;
    if (!session->wants)
        session->waits_since = server->clock++;
    session->wants = true;
    return 0;
}

// Sends what has LWS_PRE bytes of room before it, and releases it. NULL: memory has run out.
static int write_message(struct session *session, uint8_t *message, size_t size, enum lws_write_protocol kind)
{
    int written = message ? lws_write(session->wsi, message + LWS_PRE, size, kind) : -1;
    free(message);
    lws_callback_on_writable(session->wsi);
    return written < 0 ? -1 : 0;
}

static int write_reply(const struct server *server, struct session *session)
{
    size_t size = json_dumpb(session->reply, NULL, 0, JSON_COMPACT);
    uint8_t *message = size ? orl_array(server->log, LWS_PRE + size, 1) : NULL;
    if (message)
        (void)json_dumpb(session->reply, (char *)message + LWS_PRE, size, JSON_COMPACT);
    json_decref(session->reply);
    session->reply = NULL;
    return write_message(session, message, size, LWS_WRITE_TEXT);
}

// Sends the frame. The next one is drawn only after this one has been handed to the network.
static int write_frame(const struct server *server, struct session *session)
{
    uint8_t *frame = session->frame;
    if (session->reply)
        return write_reply(server, session);
    session->sending = frame != NULL;
    session->frame = NULL;
    return frame ? write_message(session, frame, session->frame_size, LWS_WRITE_BINARY) : 0;
}

static struct session *longest_waiting(const struct server *server)
{
    struct session *longest = NULL;
    for (struct lws_dll2 *link = server->sessions.head; link; link = link->next) {
        struct session *s = session_of(link);
        if (s->wants && !s->sending && (!longest || s->waits_since < longest->waits_since))
            longest = s;
    }
    return longest;
}

// A method that a client has chosen may fail in this scene without ending the server: the client
// goes back to the first choice.
static enum orl_result give_up_choice(const struct server *server, struct session *session,
                                      enum orl_result failure)
{
    const struct orl_choice *first = server->params->choice;
    if (memcmp(&session->choice.params, &first->params, sizeof first->params) == 0)
        return failure;
    session->choice = *first;
    return tell_choice(session, orl_result_message(failure));
}

static enum orl_result answer(struct server *server, struct session *session)
{
    struct walk_frame frame;
    int live = server->live ? orl_live_take(server->live) : -1;
    if (live >= 0)
        session->request.time_step = session->request.expected = live;
    enum orl_result result = orl_walk_frame(&server->walk, &session->request,
                                            &session->choice.params, LWS_PRE, &frame);
    if (result == ORL_OK && server->live)
        orl_live_drawn(server->live);
    if (result != ORL_OK)
        return give_up_choice(server, session, result); // drawn once more, as first chosen
    session->frame = frame.data;
    session->frame_size = frame.size;
    session->wants = false;
    session->sending = true;
    if (frame.figures)
        return reply(session, json_pack("{s:o}", "figures", frame.figures));
    lws_callback_on_writable(session->wsi);
    return ORL_OK;
}

// --- events ---

static int on_event(struct lws *wsi, enum lws_callback_reasons reason, void *user, void *data,
                    size_t size)
{
    struct server *server = lws_context_user(lws_get_context(wsi));
    struct session *session = user;
    switch (reason) {
    case LWS_CALLBACK_HTTP:
        return start_file(server, wsi, session, data);
    case LWS_CALLBACK_HTTP_WRITEABLE:
        return session->file.data ? continue_file(wsi, session) : 0;
    case LWS_CALLBACK_CLOSED_HTTP:
        if (session)
            forget_file(session);
        return 0;
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
        return asks_from_here(server, wsi) && has_token(server, wsi) &&
                       server->sessions.count < CLIENTS_MAX
                   ? 0
                   : -1;
    case LWS_CALLBACK_ESTABLISHED:
        *session = (struct session){.wsi = wsi, .choice = *server->params->choice};
        lws_dll2_add_head(&session->link, &server->sessions);
        return 0;
    case LWS_CALLBACK_RECEIVE:
        return take_message(server, session, data, size);
    case LWS_CALLBACK_SERVER_WRITEABLE:
        return write_frame(server, session);
    case LWS_CALLBACK_CLOSED:
        remove_session(server, session);
        return 0;
    case LWS_CALLBACK_FILTER_HTTP_CONNECTION:
    case LWS_CALLBACK_EVENT_WAIT_CANCELLED:
        return 0;
    default:
        return lws_callback_http_dummy(wsi, reason, user, data, size);
    }
}

// --- the server ---

// Fails early: libwebsockets would wait for an address that this machine does not have.
static enum orl_result check_address(const struct orl_log *log, const char *host)
{
    const struct addrinfo hints = {.ai_socktype = SOCK_STREAM, .ai_flags = AI_PASSIVE};
    struct addrinfo *found = NULL;
    bool ours = false;
    if (getaddrinfo(host, NULL, &hints, &found) == 0) {
        int probe = socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
        ours = probe >= 0 && bind(probe, found->ai_addr, found->ai_addrlen) == 0;
        if (probe >= 0)
            close(probe);
        freeaddrinfo(found);
    }
    return ours ? ORL_OK : orl_fail(log, ORL_ERR_ARGUMENT, "cannot listen on %s: it is no address of "
                                    "this machine", host);
}

// The page is made of this server's files alone, and other sites may neither frame it, unless
// --embed-in names them, nor show its pictures.
static enum orl_result make_headers(struct server *server)
{
    static const struct lws_protocol_vhost_options same[] = {
        {&same[1], NULL, "x-content-type-options:", "nosniff"},
        {&same[2], NULL, "referrer-policy:", "no-referrer"}, // the address may hold the token
        {&same[3], NULL, "cross-origin-resource-policy:", "same-origin"},
        {&same[4], NULL, "cache-control:", "no-cache"},
        {NULL, NULL, "allow:", "GET, HEAD"}};
    const char *others = server->params->embed_in ? server->params->embed_in : "";
    int length = snprintf(server->policy, sizeof server->policy,
                          "default-src 'self'; img-src 'self' blob: data:; base-uri 'none'; "
                          "form-action 'none'; frame-ancestors 'self' %s", others);
    if (length >= (int)sizeof server->policy || strpbrk(others, ";,\r\n"))
        return orl_fail(server->log, ORL_ERR_ARGUMENT, "--embed-in %s: must be origins such as "
                        "https://museum.example, with spaces between them", others);
    server->headers = (struct lws_protocol_vhost_options){same, NULL, "content-security-policy:", server->policy};
    return ORL_OK;
}

static enum orl_result listen_there(struct server *server)
{
    static const struct lws_protocols protocols[] = {
        {"http", on_event, sizeof(struct session), RECEIVE, 0, NULL, 0},
        {"oriel-walk", on_event, sizeof(struct session), RECEIVE, 0, NULL, 0},
        {NULL, NULL, 0, 0, 0, NULL, 0}};
    const struct orl_walk_params *params = server->params;
    struct lws_context_creation_info info = {
        .port = params->port, .iface = params->host, .protocols = protocols,
        .user = server, .headers = &server->headers, .timeout_secs = IDLE_S, .keepalive_timeout = IDLE_S,
        .options = LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND, .gid = (gid_t)-1, .uid = (uid_t)-1};
    lws_set_log_level(LLL_ERR, NULL);
    server->context = lws_create_context(&info);
    if (!server->context)
        return orl_fail(server->log, ORL_ERR_IO, "cannot listen on %s, port %d: it is taken",
                        params->host, params->port);
    if (!is_local(params->host) && lws_hex_random(server->context, server->token, sizeof server->token) != 0)
        return orl_fail(server->log, ORL_ERR_IO, "no random numbers for a token");
    int port = lws_get_vhost_listen_port(lws_get_vhost_by_name(server->context, "default"));
    char address[256];
    snprintf(address, sizeof address, "http://%s:%d/%s%s", params->host, port,
             server->token[0] ? "?token=" : "", server->token);
    params->ready(params->priv, address);
    if (strcmp(params->host, "0.0.0.0") == 0)
        orl_logf(server->log, ORL_LOG_INFO, "on another machine, put this machine's name or address in place of 0.0.0.0");
    return ORL_OK;
}

// At most one frame, and what has come from the network. waits: until something comes.
static enum orl_result serve_once(struct server *server, bool waits)
{
    struct session *session = longest_waiting(server);
    enum orl_result result = session ? answer(server, session) : ORL_OK;
    if (session || !waits)
        lws_cancel_service(server->context); // process network events without waiting
    if (result == ORL_OK && lws_service(server->context, 0) < 0 && errno != EINTR)
        result = orl_fail(server->log, ORL_ERR_IO, "the network cannot be served");
    return result;
}

// Serves clients while something else is under way. Of a sequence they may ask for other time steps, after which that
// goes on with its own; what cameras show now has the newest alone.
static enum orl_result serve_meanwhile(struct server *server)
{
    struct orl_scene *scene = server->walk.scene;
    int frame = scene->frame;
    ORL_TRY(serve_once(server, false));
    return server->live || scene->frame == frame ? ORL_OK : orl_scene_set_frame(server->log, scene, frame);
}

// Between two frames of a rendering, clients are served.
static void report_rendering(void *priv, size_t done, size_t total, const char *file)
{
    struct server *server = priv;
    if (server->result == ORL_OK && server->renders_for)
        server->result = reply(server->renders_for,
                               json_pack("{s:{s:I, s:I, s:o}}", "rendering", "done", (json_int_t)done,
                                         "total", (json_int_t)total, "file", orl_json_string(file)));
    ORL_THEN(server->result, serve_meanwhile(server));
}

// What a client asks for may fail without ending the server.
static void render_path(struct server *server)
{
    const struct walk_rendering rendering = {
        .log = server->log, .scene = server->content.scene, .renderer = server->walk.renderer,
        .render = &server->render_choice.params, .progress = server->params->progress,
        .report = report_rendering, .priv = server};
    enum orl_result result = orl_walk_rendering_run(&rendering, server->to_render);
    if (result != ORL_OK && server->renders_for && server->result == ORL_OK)
        server->result = refuse_rendering(server->renders_for, orl_result_message(result));
    server->renders_for = NULL;
    json_decref(server->to_render);
    server->to_render = NULL;
}

// Between two photographs of the site, clients are served.
static void report_site(void *priv, const char *step, double done, double total,
                        const char *detail)
{
    struct server *server = priv;
    (void)step;
    (void)detail;
    ORL_THEN(server->result, tell_site(server, json_pack("{s:f, s:f}", "done", done, "total", total), false));
    ORL_THEN(server->result, serve_meanwhile(server));
}

static bool site_cancelled(void *priv)
{
    const struct server *server = priv;
    return server->result != ORL_OK || orl_progress_cancelled(server->params->progress);
}

// That it fails does not end the server.
static void make_site(struct server *server)
{
    const struct orl_progress progress = {report_site, site_cancelled, server};
    struct orl_scene *scene = server->walk.scene;
    int frame = scene->frame;
    enum orl_result result = ORL_OK;
    if (server->live)
        result = orl_fail(server->log, ORL_ERR_UNSUPPORTED, "what cameras show now is not published");
    else if (scene->frame_count) // a site begins with what the scene itself shows, as that of oriel publish
        result = orl_scene_set_frame(server->log, scene, -1);
    ORL_THEN(result, orl_content_publish(&server->content, server->walk.gpu, scene, server->params->radiance,
                                         &progress));
    if (scene->frame != frame && !server->live)
        ORL_THEN(server->result, orl_scene_set_frame(server->log, scene, frame));
    if (result == ORL_OK)
        ORL_THEN(server->result, tell_site_ready(server));
    else
        ORL_THEN(server->result, tell_site(server, json_pack("{s:s}", "problem", orl_result_message(result)), true));
}

static enum orl_result serve(struct server *server)
{
    while (server->result == ORL_OK && !orl_progress_cancelled(server->params->progress)) {
        if (server->to_render)
            render_path(server);
        else if (someone_asks_site(server))
            make_site(server);
        ORL_THEN(server->result, serve_once(server, !server->to_render && !someone_asks_site(server)));
    }
    return server->result;
}

enum orl_result orl_walk_serve(struct orl_gpu *gpu, struct orl_renderer *renderer,
                               struct orl_scene *scene, const struct orl_walk_params *params)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    struct server server = {.log = log, .params = params};
    server.walk = (struct walk_renderer){
        .log = log, .gpu = gpu, .renderer = renderer, .scene = scene,
        .typical = scene->photo_distance > 0 ? (float)scene->photo_distance : 1};
    bool edits = is_local(params->host) || params->edits;
    enum orl_result result =
        params->live ? orl_live_start(log, scene, params->live, &server.live) : ORL_OK;
    ORL_THEN(result, orl_content_init(log, scene, params->title, edits, params->choice, &server.content));
    ORL_THEN(result, check_address(log, params->host));
    ORL_THEN(result, orl_walk_warm_up(&server.walk, &params->choice->params));
    ORL_THEN(result, make_headers(&server));
    ORL_THEN(result, listen_there(&server));
    ORL_THEN(result, serve(&server));
    if (server.context)
        lws_context_destroy(server.context);
    orl_live_stop(&server.live);
    orl_content_finish(&server.content);
    json_decref(server.to_render);
    return result;
}
