export type Of = "program" | "source";

/** Where a job has the files of a text beside the first. */
export const MORE = { program: "parts", source: "sources" } as const;
