// What a person gives, as the server wants it.

import { describe, expect, it } from "vitest";

import { contentsOf, titleOf } from "../src/start/files";
import { matched } from "../src/start/upload";

const given = (path: string, size = 3) => ({ path, file: new File([new Uint8Array(size)], path.split("/").pop()!) });

describe("titleOf", () => {
  it("is the folder, the file without its ending, or how many there are", () => {
    expect(titleOf([given("kitchen/a.jpg"), given("kitchen/b.jpg")])).toBe("kitchen");
    expect(titleOf([given("IMG_2041.MOV")])).toBe("IMG_2041");
    expect(titleOf([given("a.jpg"), given("b.jpg")])).toBe("2 photos");
    expect(titleOf([given("a.jpg"), given("b.txt")])).toBe("2 files");
  });

  it("is shown with the number of files while they are sent", () => {
    expect(contentsOf([given("kitchen/a.jpg"), given("kitchen/b.jpg")])).toBe("kitchen: 2 files");
    expect(contentsOf([given("a.jpg"), given("b.txt")])).toBe("2 files");
    expect(contentsOf([given("IMG_2041.MOV")])).toBe("IMG_2041.MOV");
  });
});

it("sends the files that the server wants, in its order, without those that it left out", () => {
  const all = [given("k/.DS_Store", 9), given("k/b.jpg", 2), given("k/a.jpg", 1)];
  const made = { id: "x", title: "k", files: [{ path: "a.jpg", size: 1 }, { path: "b.jpg", size: 2 }] };
  expect(matched(all, made).map((file) => file.size)).toEqual([1, 2]);
});
